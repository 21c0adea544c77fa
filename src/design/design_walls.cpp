// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/design_walls.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/soil/face_stability.hpp>

#include "base/plan_geometry.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "machine/machine_mass.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Numbers of our own choice, but for the first two.
/// Deeper walls, if steeper than that batter, need a proof that they stand: DIN 4124, recalled [m].
constexpr double proof_from = 1.25;
constexpr double proof_below_batter = 1.0;
constexpr double least_proven = 1.3;  // factor of safety of these
constexpr double least_usual = 1.1;   // of others
constexpr double lowest_wall = 0.3;   // [m]
/// Of grains held by their moisture alone, which a deep cut does not count on [Pa].
constexpr double apparent_cohesion = 1500.0;
constexpr double between_walls = 0.5;  // [m]
constexpr double farthest_toe = 3.0;   // of the height of a wall
constexpr double nearly = 0.98;        // of a height: there is the toe
constexpr double loaded_over = 2.0;    // beyond an edge, in heights
constexpr int direction_cells = 2;     // around a cell of the edge that tell its direction

struct Edge {
  Cell cell;
  Vector2d outward = Vector2d::Zero();
};

double distance_to(const std::vector<Vector2d>& line, const Vector2d& place) {
  double least = (place - line.front()).norm();
  for (std::size_t i = 1; i < line.size(); ++i)
    least = std::min(least, distance_to_side(place, line[i - 1], line[i]));
  return least;
}

bool needs_proof(double height, double batter) {
  return height > proof_from && batter < proof_below_batter;
}

SoilState soil_at(const WallSoil& bank, const DesignWall& wall) {
  SoilState soil = needs_proof(wall.height, wall.batter) ? bank.sure : bank.believed;
  if (wall.height > proof_from && soil.cohesion <= apparent_cohesion) soil.cohesion = 0.0;
  return soil;
}

/// With the factor that it needs.
DesignWall wall_of(double height, double batter) {
  DesignWall wall;
  wall.height = height;
  wall.batter = batter;
  wall.least = needs_proof(height, batter) ? least_proven : least_usual;
  return wall;
}

/// With nothing beside it.
SoilFace bare_face(const DesignWall& wall) {
  SoilFace face;
  face.height = wall.height;
  face.run = wall.batter * wall.height;
  return face;
}

std::optional<double> batter_for(const WallSoil& bank, const DesignWall& wall) {
  return standing_batter(soil_at(bank, wall), bare_face(wall), wall.least);
}

class WallCheck {
 public:
  explicit WallCheck(const WallTask& task) : task_(task) {}

  std::optional<DesignWall> weakest(const std::vector<Vector2d>& about, double within) const {
    std::optional<DesignWall> weakest;
    std::vector<Vector2d> looked_at;
    for (const Edge& edge : edges()) {
      const Vector2d place = place_of(edge.cell);
      if (!about.empty() && distance_to(about, place) > within) continue;
      if (std::any_of(looked_at.begin(), looked_at.end(), [&](const Vector2d& other) {
            return (other - place).norm() < between_walls;
          }))
        continue;
      looked_at.push_back(place);
      const auto wall = wall_at(edge);
      if (!wall || wall->factor >= wall->least) continue;
      if (!weakest || wall->factor / wall->least < weakest->factor / weakest->least) weakest = wall;
    }
    if (weakest) weakest->standing = batter_for(task_.bank, *weakest);
    return weakest;
  }

 private:
  Vector2d place_of(Cell cell) const {
    return {task_.target.x(cell.col), task_.target.y(cell.row)};
  }
  bool is_design(Index row, Index col) const {
    const Eigen::ArrayXXd& z = task_.target.z;
    return row >= 0 && col >= 0 && row < z.rows() && col < z.cols() && !std::isnan(z(row, col));
  }

  /// Cells of the design beside which there is none.
  std::vector<Edge> edges() const {
    std::vector<Edge> found;
    for_each_cell(task_.target.z, [&](Cell at) {
      if (!is_design(at.row, at.col)) return;
      if (is_design(at.row - 1, at.col) && is_design(at.row + 1, at.col) &&
          is_design(at.row, at.col - 1) && is_design(at.row, at.col + 1))
        return;
      Vector2d outward = Vector2d::Zero();
      for (Index down = -direction_cells; down <= direction_cells; ++down) {
        for (Index right = -direction_cells; right <= direction_cells; ++right) {
          if (!is_design(at.row + down, at.col + right))
            outward += Vector2d(static_cast<double>(right), static_cast<double>(down));
        }
      }
      if (outward.norm() > 0.0) found.push_back({at, outward.normalized()});
    });
    return found;
  }

  /// Of an array on the map's cells; NaN beside it.
  double at(const Eigen::ArrayXXd& values, const Vector2d& place) const {
    const auto cell = cell_at(task_.target, place.x(), place.y());
    return cell ? values(cell->row, cell->col) : std::nan("");
  }

  /// The face from the edge to the foot of what is cut there.
  std::optional<DesignWall> wall_at(const Edge& edge) const {
    const Vector2d place = place_of(edge.cell);
    const double cell = task_.target.cell_size;
    const double top = at(task_.before, place);
    if (std::isnan(top)) return std::nullopt;
    std::vector<double> depths;
    double deepest = 0.0;
    for (double run = 0.0;; run += cell) {
      const double target = at(task_.target.z, place - run * edge.outward);
      if (std::isnan(target)) break;
      depths.push_back(top - target);
      deepest = std::max(deepest, depths.back());
      if (run > farthest_toe * std::max(deepest, lowest_wall)) break;
    }
    if (deepest < lowest_wall) return std::nullopt;
    const auto toe = std::find_if(depths.begin(), depths.end(),
                                  [&](double depth) { return depth >= nearly * deepest; });
    DesignWall wall = wall_of(deepest, static_cast<double>(toe - depths.begin()) * cell / deepest);
    wall.edge = place;
    wall.factor = factor_of_safety(soil_at(task_.bank, wall), face_of(wall, edge.outward));
    return wall;
  }

  SoilFace face_of(const DesignWall& wall, const Vector2d& outward) const {
    SoilFace face = bare_face(wall);
    const double top = at(task_.before, *wall.edge);
    for (double x = 0.5 * face.load_step; x < loaded_over * wall.height; x += face.load_step)
      face.loads.push_back(load_on(*wall.edge + x * outward, top));
    return face;
  }

  /// Of ground higher than the edge, of spoil and of tracks [Pa].
  double load_on(const Vector2d& place, double edge) const {
    double load = 0.0;
    const double ground = at(task_.before, place);
    if (ground > edge) load += task_.bank.believed.unit_weight * (ground - edge);
    const auto cell = cell_at(task_.ground.bank, place.x(), place.y());
    const double now =
        cell ? task_.ground.bank.z(cell->row, cell->col) + task_.ground.loose(cell->row, cell->col)
             : std::nan("");
    if (now > ground) load += task_.loose.unit_weight * (now - ground);
    return load + track_pressure(place);
  }

  double track_pressure(const Vector2d& place) const {
    const Machine& machine = task_.machine;
    if (!task_.base || !machine.body) return 0.0;
    const PlanFrame frame({task_.base->x, task_.base->y}, task_.base->heading);
    const Vector2d on = frame.of(place);
    const TrackPrint tracks(machine);
    return tracks.covers(on.x(), on.y()) ? gravity * total_mass(machine) / tracks.area() : 0.0;
  }

  const WallTask& task_;
};

}  // namespace

std::optional<DesignWall> weakest_wall(const WallTask& task, const std::vector<Vector2d>& about,
                                       double within) {
  return WallCheck(task).weakest(about, within);
}

std::optional<DesignWall> weak_wall(const WallSoil& bank, double height, double batter) {
  if (height < lowest_wall) return std::nullopt;
  DesignWall wall = wall_of(height, batter);
  wall.factor = factor_of_safety(soil_at(bank, wall), bare_face(wall));
  if (wall.factor >= wall.least) return std::nullopt;
  wall.standing = batter_for(bank, wall);
  return wall;
}

Warning warning_of(const DesignWall& wall) {
  const std::string asked_for = !wall.standing ? "shore it"
                                : *wall.standing > wall.batter
                                    ? "give it a batter of " + readable(*wall.standing, 2) +
                                          " (horizontal per vertical), or shore it"
                                    : "keep spoil and tracks off its edge, or shore it";
  const std::string where = wall.edge ? " at x = " + readable(wall.edge->x(), 2) +
                                            " m, y = " + readable(wall.edge->y(), 2) + " m"
                                      : std::string();
  return {WarningCode::unstable_wall, "the wall" + where + ", " + readable(wall.height, 2) +
                                          " m high with a batter of " + readable(wall.batter, 2) +
                                          ", may fail: its factor of safety is " +
                                          readable(wall.factor, 2) + ", it needs " +
                                          readable(wall.least, 2) + "; " + asked_for};
}

}  // namespace excavplan
