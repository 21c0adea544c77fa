// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/non_finite.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;

// Ours:
constexpr double face = 0.25;           // width over which a face is looked for [m]
constexpr double steepest = 1.732;      // of ground: 60 degrees
constexpr double largest = 20.0;        // of an obstacle: the top of a truck [m^2]
constexpr double own_rim = 0.3;         // within which ground of its own height adjoins a rim [m]
constexpr double around = 1.2;          // within which else the ground around is looked for [m]
constexpr double least_falling = 0.25;  // of the rim of an obstacle that is a face

Index cells_in(double length, double cell) {
  return std::max<Index>(1, static_cast<Index>(std::lround(length / cell)));
}

class ObstacleFinder {
 public:
  explicit ObstacleFinder(const HeightMap& highest)
      : cell_(highest.cell_size), z_(highest.z), known_(highest.z.isFinite()) {
    const Index half = cells_in(0.5 * face, cell_);
    foot_ = lowest_within(without_nan(z_, infinity), half);
    const ArrayXXd top = highest_within(without_nan(z_, -infinity), half);
    rise_ = std::max(0.5 * least_obstacle, steepest * 2.0 * static_cast<double>(half) * cell_);
    steep_ = known_ && (top - foot_ > rise_);
    part_ = Eigen::ArrayXXi::Zero(z_.rows(), z_.cols());
  }

  CellMask find() {
    if (!steep_.any()) return CellMask::Constant(z_.rows(), z_.cols(), false);
    std::vector<bool> stands(1, false);  // of each part; 0: no part
    for (Index col = 0; col < z_.cols(); ++col) {
      for (Index row = 0; row < z_.rows(); ++row) {
        if (!is_even(row, col) || part_(row, col) != 0) continue;
        stands.push_back(stands_on_faces(row, col, static_cast<int>(stands.size())));
      }
    }
    CellMask found =
        part_.unaryExpr([&](int part) -> bool { return stands[static_cast<std::size_t>(part)]; });
    const ArrayXXd ground = (known_ && !steep_ && !found).select(z_, -infinity);
    ArrayXXd level = highest_within(ground, cells_in(own_rim, cell_));
    if ((steep_ && level == -infinity).any()) {
      const ArrayXXd near = highest_within(ground, cells_in(around, cell_));
      const ArrayXXd farther = (near > -infinity).select(near, foot_);
      level = (level > -infinity).select(level, farther).eval();
    }
    return found || (steep_ && z_ - level > least_obstacle);
  }

 private:
  bool is_even(Index row, Index col) const { return known_(row, col) && !steep_(row, col); }

  /// Marks the even cells that hang together with one. @return whether they are the top of an
  /// obstacle: faces fall from a good part of their rim
  bool stands_on_faces(Index row, Index col, int part) {
    std::vector<std::pair<Index, Index>> cells = {{row, col}};
    part_(row, col) = part;
    double rim = 0.0, falling = 0.0;
    bool at_border = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto [r, c] = cells[i];
      for (const auto& [down, right] :
           std::array<std::pair<Index, Index>, 4>{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}}) {
        const Index to_row = r + down, to_col = c + right;
        if (to_row < 0 || to_col < 0 || to_row >= z_.rows() || to_col >= z_.cols()) {
          at_border = true;
        } else if (is_even(to_row, to_col)) {
          if (part_(to_row, to_col) != 0) continue;
          part_(to_row, to_col) = part;
          cells.emplace_back(to_row, to_col);
        } else {
          rim += 1.0;
          const bool falls = steep_(to_row, to_col) && z_(r, c) - foot_(to_row, to_col) > rise_;
          if (falls) falling += 1.0;
        }
      }
    }
    const double area = static_cast<double>(cells.size()) * cell_ * cell_;
    return !at_border && area <= largest && falling > least_falling * rim;
  }

  double cell_;
  const ArrayXXd& z_;
  CellMask known_, steep_;
  ArrayXXd foot_;  ///< the lowest within half of a face
  double rise_;    ///< of a face over its width [m]
  Eigen::ArrayXXi part_;
};

}  // namespace

CellMask find_obstacles(const HeightMap& highest) { return ObstacleFinder(highest).find(); }

std::optional<ObstacleTop> highest_obstacle(
    const Terrain& terrain, const std::function<bool(const Eigen::Vector2d&)>& in_part) {
  const ArrayXXd& tops = terrain.obstacles;
  const ArrayXXd& returns = terrain.obstacle_returns.size() > 0 ? terrain.obstacle_returns : tops;
  std::optional<ObstacleTop> highest;
  for_each_cell(tops, [&](Cell at) {
    const double top = tops(at.row, at.col), seen = returns(at.row, at.col);
    const Eigen::Vector2d place(terrain.bank.x(at.col), terrain.bank.y(at.row));
    if (std::isnan(top) || !in_part(place)) return;
    if (!highest) highest = ObstacleTop{place, top, seen};
    if (top > highest->counted) {
      highest->place = place;
      highest->counted = top;
    }
    highest->seen = std::max(highest->seen, seen);
  });
  return highest;
}

std::optional<ObstacleTop> highest_obstacle(const Terrain& terrain, const Eigen::Vector2d& about,
                                            double within) {
  return highest_obstacle(terrain, [&](const Eigen::Vector2d& place) {
    return (place - about).cwiseAbs().maxCoeff() <= within;
  });
}

std::string text(const ObstacleTop& top) {
  constexpr double same = 0.05;  // ours [m]
  if (!(top.counted - top.seen > same)) return readable(top.counted, 2) + " m high";
  return readable(top.seen, 2) + " m high by its highest return and counted up to " +
         readable(top.counted, 2) + " m";
}

Terrain with_obstacles(const Terrain& terrain) {
  if (terrain.obstacles.size() > 0) return terrain;
  const HeightMap surface = terrain.surface();
  const CellMask found = find_obstacles(surface);
  if (!found.any()) return terrain;
  Terrain result = terrain;
  const double none = std::nan("");
  result.obstacles = found.select(surface.z, none);
  result.bank.z = found.select(none, surface.z - terrain.loose);
  return result;
}

}  // namespace excavplan
