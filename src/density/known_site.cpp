// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/known_site.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_sampling.hpp"

namespace excavplan {
namespace {

constexpr double standing = 0.2;  // ours: nearer to the top of a known obstacle it still stands [m]
constexpr double in_the_way = 0.3;  // ours: a thing as high is an obstacle [m]
constexpr int samples_per_cell = 8;  // of the tip's line

Eigen::ArrayXXd known_or(const Eigen::ArrayXXd& layer, double other) {
  return layer.isNaN().select(other, layer);
}

/// Mean height of the floor in a column of cells, and the share of the column that it covers.
struct ColumnFloor {
  double height = std::nan("");
  double share = 0.0;
};

ColumnFloor column_floor(const DigPath& path, const HeightMap& grid, Eigen::Index col) {
  double sum = 0.0;
  int known = 0;
  for (int i = 0; i < samples_per_cell; ++i) {
    const double x = grid.x(col) + grid.cell_size * ((i + 0.5) / samples_per_cell - 0.5);
    const double floor = swept_height(path, x);
    if (std::isnan(floor)) continue;
    sum += floor;
    ++known;
  }
  if (known == 0) return {};
  return {sum / known, static_cast<double>(known) / samples_per_cell};
}

/// By how much the ground that was known lies above the scan before where nothing changed.
double offset_of(const GroundState& ground, const SurfacePair& surfaces, const AreaChange& area) {
  const HeightMap& before = surfaces.before.height;
  const Eigen::ArrayXXd known =
      layer_on(before, ground.terrain.bank, ground.terrain.surface().z);
  std::vector<double> offsets;
  for_each_cell(known, [&](Cell at) {
    const double offset = known(at.row, at.col) - before.z(at.row, at.col);
    if (area.zone(at.row, at.col) < 0 && !std::isnan(offset)) offsets.push_back(offset);
  });
  return offsets.empty() ? 0.0 : median(offsets);
}

int cause_of(const VolumeChange& change, int zone) {
  if (zone < 0) return 0;
  return change.zones[static_cast<std::size_t>(zone)].kind == ZoneKind::other ? 2 : 1;
}

/// The survey after a dig, in the heights of the known ground.
SeenGround seen_after(const SurfacePair& surfaces, const VolumeChange& change,
                      const KnownGround& known, double offset) {
  const AreaChange& area = change.areas.front();
  const HeightMap& before = surfaces.before.height;
  SeenGround seen;
  seen.surface = realigned(surfaces.after.height, surfaces.alignment);
  seen.surface.z = area.difference.z.isNaN().select(seen.surface.z - area.datum,
                                                    before.z + area.difference.z);
  const double stable = 0.5 * area.noise_sd * area.noise_sd;
  const Eigen::ArrayXXd& own = surfaces.after.variance;
  seen.deviation.setConstant(before.z.rows(), before.z.cols(), stable);
  if (own.size() > 0) seen.deviation = (own > stable).select(own, stable);
  seen.deviation = seen.deviation.sqrt();
  seen.changed.setZero(before.z.rows(), before.z.cols());
  seen.obstacles.setConstant(before.z.rows(), before.z.cols(), std::nan(""));
  for_each_cell(area.zone, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    seen.changed(at.row, at.col) = cause_of(change, zone);
    double& height = seen.surface.z(at.row, at.col);
    height += offset;
    const bool is_thing = zone >= 0 && std::isnan(area.difference.z(at.row, at.col)) &&
                          change.zones[static_cast<std::size_t>(zone)].unknown_share >= 1.0;
    if (!is_thing) return;
    const double rise = height - offset - before.z(at.row, at.col);
    if (rise > in_the_way) seen.obstacles(at.row, at.col) = height;
    height = std::nan("");
  });
  if (known.swept.size() > 0) {
    constexpr double most = 0.5;  // of a cell, that counts as swept
    seen.swept = (known.cover > most).select(known.swept + offset, std::nan(""));
  }
  return seen;
}

}  // namespace

Scan scan_of(const GroundState& ground) {
  const HeightMap surface = ground.terrain.surface();
  auto cloud = std::make_shared<Cloud>();
  const double quarter = 0.25 * surface.cell_size;
  for_each_cell(surface.z, [&](Cell at) {
    const double z = surface.z(at.row, at.col);
    if (std::isnan(z)) return;
    for (const double x : {-quarter, quarter}) {
      for (const double y : {-quarter, quarter}) {
        cloud->points.emplace_back(surface.x(at.col) + x, surface.y(at.row) + y, z);
      }
    }
  });
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  scan.name = "known ground";
  return scan;
}

void set_deviation(const GroundState& ground, Surface& before) {
  if (ground.deviation.size() == 0 || before.variance.size() == 0) return;
  const Eigen::ArrayXXd told = layer_on(before.height, ground.terrain.bank, ground.deviation);
  before.variance = (told.square() > before.variance || before.variance.isNaN())
                        .select(told.square(), before.variance);
}

void leave_out_obstacles(const GroundState& ground, Surface& before) {
  const Eigen::ArrayXXd& obstacles = ground.terrain.obstacles;
  if (obstacles.size() == 0) return;
  const Eigen::ArrayXXd tops = layer_on(before.height, ground.terrain.bank, obstacles);
  before.height.z = (before.height.z > tops - standing).select(std::nan(""), before.height.z);
}

KnownGround known_ground_on(const HeightMap& grid, const GroundState& ground,
                            const SoilKind* soil) {
  const Terrain& terrain = ground.terrain;
  const auto on_grid = [&](const Eigen::ArrayXXd& layer) {
    return layer_on(grid, terrain.bank, layer);
  };
  KnownGround known;
  known.loose = known_or(on_grid(terrain.bank.z.isNaN().select(std::nan(""), terrain.loose)), 0.0);
  if (ground.deviation.size() > 0) {
    known.loose_sd = std::sqrt(2.0) * known_or(on_grid(ground.deviation), 0.0);
  }
  if (soil != nullptr && terrain.loose_void_ratio.size() > 0) {
    known.swelling = known_or(
        (1.0 + soil->void_ratio_loose) / (1.0 + on_grid(terrain.loose_void_ratio)) - 1.0, 0.0);
  }
  return known;
}

void add_swept_floor(const DigPath& path, const Machine& machine, const HeightMap& grid,
                     KnownGround& known) {
  const double half = 0.5 * machine.bucket.width_outside;
  known.swept.setConstant(grid.z.rows(), grid.z.cols(), std::nan(""));
  known.cover.setZero(grid.z.rows(), grid.z.cols());
  for (Eigen::Index col = 0; col < grid.z.cols(); ++col) {
    const ColumnFloor floor = column_floor(path, grid, col);
    if (!(floor.share > 0.0)) continue;
    for (Eigen::Index row = 0; row < grid.z.rows(); ++row) {
      const double low = grid.y(row) - 0.5 * grid.cell_size;
      const double under = std::min(half, low + grid.cell_size) - std::max(-half, low);
      if (!(under > 0.0)) continue;
      known.swept(row, col) = floor.height;
      known.cover(row, col) = std::min(1.0, floor.share * under / grid.cell_size);
    }
  }
}

Fallback fallback_in(const KnownCut& cut) {
  Fallback fallback;
  fallback.cut = cut.bank;
  fallback.in_pit = cut.fallen;
  fallback.fraction.value = std::clamp(cut.fallen / cut.bank, 0.0, 1.0);
  fallback.fraction.sd = known_tracking_sd * cut.swept_area / cut.bank;
  fallback.seen_share =
      cut.swept_area > 0.0 ? std::max(0.0, 1.0 - cut.unseen_area / cut.swept_area) : 0.0;
  return fallback;
}

GroundState ground_after(const DensityOptions& options, const SurfacePair& surfaces,
                         const VolumeChange& change, const KnownGround& known) {
  const double offset = offset_of(*options.ground, surfaces, change.areas.front());
  SeenGround seen = seen_after(surfaces, change, known, offset);
  seen.time = options.scan_time;
  std::optional<double> loose;
  if (options.soil.kind) loose = options.soil.kind->void_ratio_loose;
  return updated_ground(*options.ground, seen, loose);
}

}  // namespace excavplan
