// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.hpp"
#include "base/statistics.hpp"
#include "ground/map_check.hpp"
#include "ground/terrain.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double heap_room = 2.0;  // around a dump point [m]; ours: a bucketful spreads about 1 m
/// Of the ground planned on [m]; ours: the bucket and its windrows.
constexpr double half_width = 1.5;
constexpr double mean_over = 0.15;  // of a scanned profile, to both sides [m]; ours

/// The two rows of cells on either side of the boom plane.
struct BoomPlaneRows {
  Index first;
  Index count;
};

BoomPlaneRows rows_at_boom_plane(const HeightMap& map) {
  const auto row = static_cast<Index>(std::floor(-map.origin.y() / map.cell_size - 0.5));
  const Index first = std::clamp<Index>(row, 0, std::max<Index>(0, map.z.rows() - 2));
  return {first, std::min<Index>(2, map.z.rows() - first)};
}

GroundProfile profile_of(const HeightMap& map, const Eigen::ArrayXXd& rows, Index first_row) {
  HeightMap strip{map.origin, map.cell_size, rows};
  strip.origin.y() += map.cell_size * static_cast<double>(first_row);
  return [strip](double x) { return height_at(strip, x, 0.0); };
}

}  // namespace

Rectangle planning_extent(const Machine& machine) {
  require_machine(machine);
  return {machine.track_front - 1.0, -half_width,
          machine.boom_pin.x() + machine.full_length() + 0.5, half_width};
}

void require_simulated_cell(double cell_size) {
  require(cell_size >= finest_cell && cell_size <= coarsest_cell,
          "the cell size is " + number_text(cell_size) + " m, must be in " +
              number_text(finest_cell) + " .. " + number_text(coarsest_cell) + " m");
}

double dig_size(const Machine& machine) {
  constexpr double usual_bucket = 1.23;  // of the zx120, pin to tip [m]
  return machine.bucket_length / usual_bucket;
}

double usual_cell(const Machine& machine) {
  constexpr double of_zx120 = 0.05;  // [m]
  const double cell = std::round(1e3 * of_zx120 * dig_size(machine)) / 1e3;
  return std::clamp(cell, finest_cell, coarsest_cell);
}

Terrain level_planning_ground(const Machine& machine) {
  return level_planning_ground(machine, usual_cell(machine));
}

Terrain level_planning_ground(const Machine& machine, double cell_size) {
  require_simulated_cell(cell_size);
  return undisturbed(flat_ground(planning_extent(machine), cell_size));
}

Rectangle swing_extent(const Machine& machine) {
  require_machine(machine);
  const double far = machine.swing_reach() + 0.5;  // as planning_extent()
  return {-far, -far, far, far};
}

Rectangle standing_extent(const Machine& machine) {
  constexpr double about = 6.0;  // [m]; ours: the foot of a drop 3 m deep may be hidden up to there
  require_machine(machine);
  const double x = machine.track_front + about;
  const double y = 0.5 * machine.undercarriage_width() + about;
  return {-x, -y, x, y};
}

Terrain level_swing_ground(const Machine& machine) {
  return undisturbed(flat_ground(swing_extent(machine), usual_cell(machine)));
}

GroundProfile boom_plane_profile(const HeightMap& surface) {
  require_grid(surface, "ground profile");
  const BoomPlaneRows rows = rows_at_boom_plane(surface);
  return profile_of(surface, surface.z.middleRows(rows.first, rows.count), rows.first);
}

GroundProfile boom_plane_profile(const Terrain& terrain) {
  require_terrain(terrain, "ground profile");
  const BoomPlaneRows rows = rows_at_boom_plane(terrain.bank);
  return profile_of(terrain.bank,
                    terrain.bank.z.middleRows(rows.first, rows.count) +
                        terrain.loose.middleRows(rows.first, rows.count),
                    rows.first);
}

GroundProfile start_profile(const HeightMap& surface, const Machine& machine) {
  require_grid(surface, "ground profile");
  require_machine(machine);
  const double half = 0.5 * machine.bucket.width_outside;
  Eigen::ArrayXXd medians(1, surface.z.cols());
  std::vector<double> known;
  for (Index col = 0; col < surface.z.cols(); ++col) {
    known.clear();
    Index count = 0;
    for (Index row = 0; row < surface.z.rows(); ++row) {
      if (std::abs(surface.y(row)) > half) continue;
      ++count;
      if (const double z = surface.z(row, col); !std::isnan(z)) known.push_back(z);
    }
    const bool is_known = !known.empty() && 2 * static_cast<Index>(known.size()) >= count;
    medians(0, col) = is_known ? mean_median(known) : std::numeric_limits<double>::quiet_NaN();
  }
  const HeightMap strip{{surface.origin.x(), -0.5 * surface.cell_size}, surface.cell_size, medians};
  return [strip](double x) { return height_at(strip, x, 0.0); };
}

GroundProfile start_profile(const Terrain& terrain, const Machine& machine) {
  require_terrain(terrain, "ground profile");
  return start_profile(terrain.surface(), machine);
}

GroundProfile profile_under_bucket(const HeightMap& surface, const Machine& machine) {
  require_grid(surface, "ground profile");
  require_machine(machine);
  return [&surface, half = 0.5 * machine.bucket.width_outside](double x) {
    double sum = 0.0;
    int count = 0;
    for (Index col = 0; col < surface.z.cols(); ++col) {
      if (std::abs(surface.x(col) - x) > mean_over) continue;
      for (Index row = 0; row < surface.z.rows(); ++row) {
        if (std::abs(surface.y(row)) > half || std::isnan(surface.z(row, col))) continue;
        sum += surface.z(row, col);
        ++count;
      }
    }
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  };
}

Rectangle swept_strip(const Machine& machine, const DigPath& path) {
  if (path.poses.empty()) refuse("swept strip: the path has no pose");
  const double half = 0.5 * machine.bucket.width_outside;
  const double start = path.poses.front().bucket.x;
  Rectangle strip{start, -half, start, half};
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::lift) break;
    strip.x_min = std::min(strip.x_min, pose.bucket.x);
    strip.x_max = std::max(strip.x_max, pose.bucket.x);
  }
  return strip;
}

double swept_height(const DigPath& path, double x) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    if (path.poses[i].phase == DigPhase::lift) break;
    const BucketPose& from = path.poses[i - 1].bucket;
    const BucketPose& to = path.poses[i].bucket;
    if (x < std::min(from.x, to.x) || x > std::max(from.x, to.x) || from.x == to.x) continue;
    const double share = (x - from.x) / (to.x - from.x);
    lowest = std::min(lowest, from.z + share * (to.z - from.z));
  }
  return std::isinf(lowest) ? std::numeric_limits<double>::quiet_NaN() : lowest;
}

double boom_plane_slope(const Terrain& terrain, double from_x, double to_x) {
  require(std::isfinite(from_x), "slope of the ground: from x", from_x, "finite");
  const GroundProfile ground = boom_plane_profile(terrain);
  const HeightMap& bank = terrain.bank;
  double count = 0.0, x_sum = 0.0, z_sum = 0.0, xx = 0.0, xz = 0.0;
  for (Index col = 0; col < bank.z.cols(); ++col) {
    const double x = bank.x(col) - from_x;
    const double z = ground(bank.x(col));
    if (x < 0.0 || bank.x(col) > to_x || std::isnan(z)) continue;
    count += 1.0;
    x_sum += x;
    z_sum += z;
    xx += x * x;
    xz += x * z;
  }
  if (count < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(count * xz - x_sum * z_sum, count * xx - x_sum * x_sum);
}

Terrain sloped_planning_ground(const Machine& machine, double slope, double cell_size) {
  constexpr double steepest = 1.5;  // [rad]
  require_in("slope of the ground [rad]", slope, -steepest, steepest);
  require_simulated_cell(cell_size);
  HeightMap ground = flat_ground(planning_extent(machine), cell_size);
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
    const double x = ground.x(col);
    ground.z.col(col) += std::tan(slope) * std::max(0.0, x - machine.track_front);
  }
  return undisturbed(ground);
}

Eigen::Vector2d default_dump_point() { return {5.5, 4.0}; }

Rectangle scene_extent(const Machine& machine, const Eigen::Vector2d& dump_at) {
  if (!dump_at.allFinite()) refuse("extent of a scene: the dump point must be finite");
  Rectangle extent = planning_extent(machine);
  extent.x_min = std::min(extent.x_min, dump_at.x() - heap_room);
  extent.x_max = std::max(extent.x_max, dump_at.x() + heap_room);
  extent.y_min = std::min(extent.y_min, dump_at.y() - heap_room);
  extent.y_max = std::max(extent.y_max, dump_at.y() + heap_room);
  return extent;
}

}  // namespace excavplan
