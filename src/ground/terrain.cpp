// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/terrain.hpp"

#include <cmath>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

bool same_size(const Eigen::ArrayXXd& a, const Eigen::ArrayXXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols();
}

/// `first .. first + count` lies in `0 .. end`, in numbers of any size.
bool lies_in(Eigen::Index first, Eigen::Index count, Eigen::Index end) {
  return first >= 0 && count <= end && first <= end - count;
}

}  // namespace

void require_terrain(const Terrain& terrain, const char* what) {
  require_grid(terrain.bank, what);
  const Eigen::ArrayXXd& z = terrain.bank.z;
  if (!same_size(terrain.loose, z)) {
    refuse(std::string(what) + ": the loose layer must be as large as the map");
  }
  for (const Eigen::ArrayXXd* layer : {&terrain.bank_void_ratio, &terrain.loose_void_ratio}) {
    if (layer->size() == 0 || same_size(*layer, z)) continue;
    refuse(std::string(what) + ": void ratios must be as large as the map");
  }
  const Eigen::ArrayXXd& tops = terrain.obstacles;
  const Eigen::ArrayXXd& returns = terrain.obstacle_returns;
  const auto& thin = terrain.thin_obstacles;
  if ((tops.size() > 0 && !same_size(tops, z)) ||
      (returns.size() > 0 && !same_size(returns, tops)) ||
      (thin.size() > 0 && (thin.rows() != tops.rows() || thin.cols() != tops.cols()))) {
    refuse(std::string(what) + ": obstacles must be as large as the map");
  }
}

HeightMap Terrain::surface() const {
  if (!same_size(loose, bank.z)) refuse("surface: the loose layer must be as large as the map");
  HeightMap map = bank;
  map.z += loose;
  return map;
}

HeightMap Terrain::highest() const {
  HeightMap map = surface();
  if (obstacles.size() == 0) return map;
  if (!same_size(obstacles, map.z)) refuse("surface: obstacles must be as large as the map");
  map.z = (obstacles > map.z || map.z.isNaN()).select(obstacles, map.z).eval();
  return map;
}

Terrain undisturbed(const HeightMap& surface) {
  return {surface, Eigen::ArrayXXd::Zero(surface.z.rows(), surface.z.cols())};
}

void require_patch(const TerrainPatch& patch, const Terrain& terrain) {
  const Eigen::Index rows = patch.bank.rows();
  const Eigen::Index cols = patch.bank.cols();
  if (rows == 0 && cols == 0) return;
  require_terrain(terrain, "patch: its terrain");
  const bool inside = lies_in(patch.row, rows, terrain.loose.rows()) &&
                      lies_in(patch.col, cols, terrain.loose.cols());
  const Eigen::ArrayXXd& ratio = patch.loose_void_ratio;
  const bool has_ratio = ratio.size() > 0;
  if (!inside || !same_size(patch.loose, patch.bank) ||
      (has_ratio && (!same_size(ratio, patch.bank) || terrain.loose_void_ratio.size() == 0))) {
    refuse("patch: " + std::to_string(rows) + " x " + std::to_string(cols) + " cells from (" +
           std::to_string(patch.row) + ", " + std::to_string(patch.col) +
           ") on, all layers alike, must lie on the terrain of " +
           std::to_string(terrain.loose.rows()) + " x " + std::to_string(terrain.loose.cols()));
  }
}

void apply(const TerrainPatch& patch, Terrain& terrain) {
  require_patch(patch, terrain);
  const Eigen::Index rows = patch.bank.rows();
  const Eigen::Index cols = patch.bank.cols();
  if (rows == 0 && cols == 0) return;
  terrain.bank.z.block(patch.row, patch.col, rows, cols) = patch.bank;
  terrain.loose.block(patch.row, patch.col, rows, cols) = patch.loose;
  if (patch.loose_void_ratio.size() == 0) return;
  terrain.loose_void_ratio.block(patch.row, patch.col, rows, cols) = patch.loose_void_ratio;
}

HeightMapVolumes height_map_volumes(const Terrain& before, const Terrain& after,
                                    const Eigen::Vector2d& dump_at, double dump_radius) {
  require_terrain(before, "volumes, before");
  require_terrain(after, "volumes, after");
  if (!same_grid(before.bank, after.bank)) refuse("volumes: before and after must be on one grid");
  if (!dump_at.allFinite()) refuse("volumes: the dump point must be finite");
  require(dump_radius >= 0.0 && std::isfinite(dump_radius), "volumes: dump radius", dump_radius,
          "at least 0 m and finite");
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
  const double volume = height_map_volumes(before, after, at).dumped;
  HeightMap rise = after.surface();
  rise.z -= before.surface().z;
  const double height = height_at(rise, at.x(), at.y());
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
