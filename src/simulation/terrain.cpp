// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/terrain.hpp>

#include <cmath>

#include "base/angles.hpp"

namespace excavplan {
HeightMap Terrain::surface() const {
  HeightMap map = bank;
  map.z += loose;
  return map;
}

Terrain undisturbed(const HeightMap& surface) {
  return {surface, Eigen::ArrayXXd::Zero(surface.z.rows(), surface.z.cols())};
}

void apply(const TerrainPatch& patch, Terrain& terrain) {
  const Eigen::Index rows = patch.bank.rows();
  const Eigen::Index cols = patch.bank.cols();
  terrain.bank.z.block(patch.row, patch.col, rows, cols) = patch.bank;
  terrain.loose.block(patch.row, patch.col, rows, cols) = patch.loose;
  if (patch.loose_void_ratio.size() > 0) {
    terrain.loose_void_ratio.block(patch.row, patch.col, rows, cols) = patch.loose_void_ratio;
  }
}

HeightMapVolumes height_map_volumes(const Terrain& before, const Terrain& after,
                                    const Eigen::Vector2d& dump_at, double dump_radius) {
  const HeightMap from = before.surface();
  const HeightMap to = after.surface();
  HeightMapVolumes volumes;
  for (Eigen::Index col = 0; col < from.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < from.z.rows(); ++row) {
      const double rise = (to.z(row, col) - from.z(row, col)) * from.cell_size * from.cell_size;
      if (std::isnan(rise)) continue;
      const bool heap =
          std::hypot(from.x(col) - dump_at.x(), from.y(row) - dump_at.y()) <= dump_radius;
      if (rise < 0.0) {
        volumes.excavated -= rise;
      } else {
        (heap ? volumes.dumped : volumes.spilled) += rise;
      }
    }
  }
  constexpr double least_hole = 1e-6;  // that has a bulking factor [m^3]; ours
  if (volumes.excavated > least_hole) {
    volumes.bulking_factor = (volumes.spilled + volumes.dumped) / volumes.excavated;
  }
  return volumes;
}

double heap_slope(const Terrain& before, const Terrain& after, const Eigen::Vector2d& at) {
  HeightMap rise = after.surface();
  rise.z -= before.surface().z;
  const double height = height_at(rise, at.x(), at.y());
  const double volume = height_map_volumes(before, after, at).dumped;
  if (!(height > 0.0 && volume > 0.0)) return std::nan("");
  const double radius = std::sqrt(3.0 * volume / (pi * height));  // of a cone
  double sum = 0.0;
  for (int i = 0; i < 36; ++i) {
    const Eigen::Vector2d out(std::cos(i * pi / 18.0), std::sin(i * pi / 18.0));
    const Eigen::Vector2d inner = at + 0.25 * radius * out;
    const Eigen::Vector2d outer = at + 0.75 * radius * out;
    sum += height_at(rise, inner.x(), inner.y()) - height_at(rise, outer.x(), outer.y());
  }
  return std::atan(sum / 36.0 / (0.5 * radius));
}

}  // namespace excavplan
