// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/known_site.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <excavplan/ground/resampling.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "scans/map_sampling.hpp"

namespace excavplan {
namespace {

constexpr double standing = 0.2;  // ours: nearer to the top of a known obstacle it still stands [m]
constexpr double in_the_way = 0.3;       // ours: a thing as high is an obstacle [m]
constexpr double between_points = 0.25;  // ours: a gap as wide counts as seen [m]
constexpr double filled_sd = 0.03;       // ours: of a height in it [m]
constexpr int samples_per_cell = 8;      // of the tip's line

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

/// Rows of cells under the bucket.
struct RowsUnder {
  const HeightMap& map;
  double half;  ///< of its width [m]
  Eigen::Index first = 0;
  Eigen::Index end;

  RowsUnder(const HeightMap& on, double half_width) : map(on), half(half_width), end(on.z.rows()) {
    while (first < end && !(cover(first) > 0.0)) ++first;
    while (end > first && !(cover(end - 1) > 0.0)) --end;
  }
  double cover(Eigen::Index row) const {
    const double low = map.y(row) - 0.5 * map.cell_size;
    const double under = std::min(half, low + map.cell_size) - std::max(-half, low);
    return std::clamp(under / map.cell_size, 0.0, 1.0);
  }
  Eigen::Index inside(Eigen::Index row) const {
    constexpr double whole = 1.0 - 1e-9;
    if (end - first < 3 || cover(row) > whole) return row;
    return row == first ? row + 1 : row - 1;
  }
};

/// By how much the ground that was known lies above the scan before where nothing changed.
double offset_of(const GroundState& ground, const SurfacePair& surfaces, const AreaChange& area) {
  const HeightMap& before = surfaces.before.height;
  const Eigen::ArrayXXd known = layer_on(before, ground.terrain.bank, ground.terrain.surface().z);
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

/// Ground between the points of a scan is as high as theirs.
void fill_between_points(SeenGround& seen) {
  const HeightMap& map = seen.surface;
  const Eigen::ArrayXXd filled = resampled(map, map.extent(), map.cell_size, between_points)
                                     .z.block(0, 0, map.z.rows(), map.z.cols());
  const Eigen::ArrayXXd own = seen.deviation;
  seen.deviation = (map.z.isNaN() && !filled.isNaN()).select(filled_sd, own);
  seen.surface.z = (map.z.isNaN() && seen.obstacles.isNaN()).select(filled, map.z);
}

/// Top of the bank that the bucket left: by what it cut, or below the hole that is seen by the soil
/// that is expected to have fallen back.
Eigen::ArrayXXd bank_left(const DigInGround& dig) {
  const Eigen::ArrayXXd bank = dig.surfaces.before.height.z - dig.known.loose;
  if (dig.known.cut.size() > 0) {
    return (dig.known.cut > 0.0).select(bank - dig.known.cut, std::nan(""));
  }
  const AreaChange& area = dig.change.areas.front();
  Eigen::ArrayXXd left = Eigen::ArrayXXd::Constant(bank.rows(), bank.cols(), std::nan(""));
  for_each_cell(left, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    if (zone < 0 || dig.change.zones[static_cast<std::size_t>(zone)].kind != ZoneKind::dig) return;
    const double seen = -area.difference.z(at.row, at.col) - dig.known.loose(at.row, at.col);
    if (seen > area.noise_sd) {
      left(at.row, at.col) = bank(at.row, at.col) - seen / (1.0 - dig.fallback);
    }
  });
  return left;
}

/// The survey after a dig, in the heights of the known ground.
SeenGround seen_after(const DigInGround& dig, double offset) {
  const AreaChange& area = dig.change.areas.front();
  const HeightMap& before = dig.surfaces.before.height;
  SeenGround seen;
  seen.surface = realigned(dig.surfaces.after.height, dig.surfaces.alignment);
  seen.surface.z =
      area.difference.z.isNaN().select(seen.surface.z - area.datum, before.z + area.difference.z);
  const double stable = 0.5 * area.noise_sd * area.noise_sd;
  const Eigen::ArrayXXd& own = dig.surfaces.after.variance;
  seen.deviation.setConstant(before.z.rows(), before.z.cols(), stable);
  if (own.size() > 0) seen.deviation = (own > stable).select(own, stable);
  seen.deviation = seen.deviation.sqrt();
  seen.changed.setZero(before.z.rows(), before.z.cols());
  seen.obstacles.setConstant(before.z.rows(), before.z.cols(), std::nan(""));
  for_each_cell(area.zone, [&](Cell at) {
    const int zone = area.zone(at.row, at.col);
    seen.changed(at.row, at.col) = cause_of(dig.change, zone);
    double& height = seen.surface.z(at.row, at.col);
    height += offset;
    const bool is_thing = zone >= 0 && std::isnan(area.difference.z(at.row, at.col)) &&
                          dig.change.zones[static_cast<std::size_t>(zone)].unknown_share >= 1.0;
    if (!is_thing) return;
    const double rise = height - offset - before.z(at.row, at.col);
    if (rise > in_the_way) seen.obstacles(at.row, at.col) = height;
    height = std::nan("");
  });
  seen.swept = bank_left(dig) + offset;
  fill_between_points(seen);
  return seen;
}

/// The ground before as the scan before shows it, where it was not known.
SeenGround seen_before(const GroundState& ground, const Surface& before, double offset) {
  SeenGround seen;
  seen.surface = before.height;
  const Eigen::ArrayXXd known = layer_on(before.height, ground.terrain.bank, ground.terrain.bank.z);
  seen.surface.z = known.isNaN().select(before.height.z + offset, std::nan(""));
  if (before.variance.size() > 0) seen.deviation = before.variance.sqrt();
  seen.changed.setZero(before.height.z.rows(), before.height.z.cols());
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
  before.points.resize(0, 0);  // what is known has no returns
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

void add_cut(const DigPath& path, const Machine& machine, const HeightMap& before,
             KnownGround& known) {
  const RowsUnder rows(before, 0.5 * machine.bucket.width_outside);
  known.cut.setZero(before.z.rows(), before.z.cols());
  known.cover.setZero(before.z.rows(), before.z.cols());
  for (Eigen::Index col = 0; col < before.z.cols(); ++col) {
    const ColumnFloor floor = column_floor(path, before, col);
    if (!(floor.share > 0.0)) continue;
    for (Eigen::Index row = rows.first; row < rows.end; ++row) {
      const Eigen::Index inside = rows.inside(row);
      const double cut = before.z(inside, col) - known.loose(inside, col) - floor.height;
      known.cover(row, col) = floor.share * rows.cover(row);
      if (cut > 0.0) known.cut(row, col) = known.cover(row, col) * cut;
    }
  }
}

Fallback fallback_in(const KnownCut& cut) {
  Fallback fallback;
  fallback.cut = cut.bank.value;
  fallback.in_pit = cut.fallen;
  fallback.fraction.value = std::clamp(cut.fallen / cut.bank.value, 0.0, 1.0);
  fallback.fraction.sd = known_tracking_sd * cut.swept_area / cut.bank.value;
  fallback.seen_share =
      cut.swept_area > 0.0 ? std::max(0.0, 1.0 - cut.unseen_area / cut.swept_area) : 0.0;
  return fallback;
}

GroundState ground_after(const DensityOptions& options, const DigInGround& dig) {
  const double offset = offset_of(*options.ground, dig.surfaces, dig.change.areas.front());
  SeenGround before = seen_before(*options.ground, dig.surfaces.before, offset);
  SeenGround after = seen_after(dig, offset);
  before.time = after.time = options.scan_time;
  std::optional<double> loose;
  if (options.soil.kind) loose = options.soil.kind->void_ratio_loose;
  return updated_ground(updated_ground(*options.ground, before), after, loose);
}

}  // namespace excavplan
