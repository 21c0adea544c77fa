// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double heap_room = 2.0;  // around a dump point [m]; ours: a bucketful spreads about 1 m
constexpr double half_width =
    1.5;  // of the ground planned on [m]; ours: the bucket and its windrows

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
  return {machine.track_front - 1.0, -half_width,
          machine.boom_pin.x() + machine.full_length() + 0.5, half_width};
}

Terrain level_planning_ground(const Machine& machine, double cell) {
  return undisturbed(flat_ground(planning_extent(machine), cell));
}

GroundProfile boom_plane_profile(const HeightMap& surface) {
  const BoomPlaneRows rows = rows_at_boom_plane(surface);
  return profile_of(surface, surface.z.middleRows(rows.first, rows.count), rows.first);
}

GroundProfile boom_plane_profile(const Terrain& terrain) {
  const BoomPlaneRows rows = rows_at_boom_plane(terrain.bank);
  return profile_of(terrain.bank,
                    terrain.bank.z.middleRows(rows.first, rows.count) +
                        terrain.loose.middleRows(rows.first, rows.count),
                    rows.first);
}

double boom_plane_slope(const Terrain& terrain, double from_x) {
  const GroundProfile ground = boom_plane_profile(terrain);
  const HeightMap& bank = terrain.bank;
  double count = 0.0, x_sum = 0.0, z_sum = 0.0, xx = 0.0, xz = 0.0;
  for (Index col = 0; col < bank.z.cols(); ++col) {
    const double x = bank.x(col) - from_x;
    const double z = ground(bank.x(col));
    if (x < 0.0 || std::isnan(z)) continue;
    count += 1.0;
    x_sum += x;
    z_sum += z;
    xx += x * x;
    xz += x * z;
  }
  if (count < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(count * xz - x_sum * z_sum, count * xx - x_sum * x_sum);
}

Terrain sloped_planning_ground(const Machine& machine, double slope, double cell) {
  HeightMap ground = flat_ground(planning_extent(machine), cell);
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
    const double x = ground.origin.x() + cell * (static_cast<double>(col) + 0.5);
    ground.z.col(col) += std::tan(slope) * std::max(0.0, x - machine.track_front);
  }
  return undisturbed(ground);
}

Eigen::Vector2d default_dump_point() { return {5.5, 4.0}; }

Rectangle scene_extent(const Machine& machine, const Eigen::Vector2d& dump_at) {
  Rectangle extent = planning_extent(machine);
  extent.x_min = std::min(extent.x_min, dump_at.x() - heap_room);
  extent.x_max = std::max(extent.x_max, dump_at.x() + heap_room);
  extent.y_min = std::min(extent.y_min, dump_at.y() - heap_room);
  extent.y_max = std::max(extent.y_max, dump_at.y() + heap_room);
  return extent;
}

}  // namespace excavplan
