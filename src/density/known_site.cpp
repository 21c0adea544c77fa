// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/known_site.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/sight_lines.hpp"
#include "scans/map_sampling.hpp"
#include "scans/return_gaps.hpp"

namespace excavplan {
namespace {

constexpr double standing = 0.2;  // ours: nearer to the top of a known obstacle it still stands [m]
constexpr double in_the_way = 0.3;   // ours: a thing as high is an obstacle [m]
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
double offset_of(const Eigen::ArrayXXd& known, const HeightMap& before, const AreaChange& area) {
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

/// The ground before a survey, on its grid.
struct GroundBefore {
  Eigen::ArrayXXd surface;    ///< NaN: not known
  Eigen::ArrayXXd obstacles;  ///< tops; NaN: none

  GroundBefore(const GroundState& ground, const HeightMap& grid)
      : surface(layer_on(grid, ground.terrain.bank, ground.terrain.surface().z)) {
    const Eigen::ArrayXXd& tops = ground.terrain.obstacles;
    obstacles = tops.size() > 0 ? layer_on(grid, ground.terrain.bank, tops)
                                : Eigen::ArrayXXd(0.0 * surface + std::nan(""));
  }
};

/// Ground is seen where there are returns, and closely between them but not below what stands on
/// it. What was filled to tell a volume is not.
void keep_to_returns(const Eigen::ArrayXXi& returns, const GroundBefore& known, SeenGround& seen) {
  Eigen::ArrayXXd& z = seen.surface.z;
  z = (returns > 0).select(z, std::nan(""));
  Eigen::ArrayXXd between = heights_between_returns(z, known.surface, seen.surface.cell_size);
  between = known.obstacles.isNaN().select(between, std::nan("")).eval();
  if (seen.obstacles.size() > 0) {
    between = seen.obstacles.isNaN().select(between, std::nan("")).eval();
  }
  seen.deviation = between.isNaN().select(seen.deviation, between_returns_sd).eval();
  z = between.isNaN().select(z, between).eval();
}

/// Accepted returns in each cell, but for those that lie in part on an edge and in part behind it.
Eigen::ArrayXXi returns_of(const Surface& surface) {
  if (surface.sensors.size() != 1) return surface.points;
  Surface own = surface;
  return (drop_mixed_returns(own) != 0).select(0, surface.points);
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
SeenGround seen_after(const DigInGround& dig, const GroundBefore& known, double offset) {
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
  // As the volumes took it, with what lies between returns that are far apart.
  Eigen::ArrayXXd taken =
      seen.surface.z.isNaN().select(before.z + area.filled + offset, seen.surface.z);
  taken = (seen.changed == 1).select(taken, std::nan("")).eval();
  keep_to_returns(returns_of(dig.surfaces.after), known, seen);
  seen.filled = seen.surface.z.isNaN().select(taken, seen.surface.z);
  if (dig.known.cut.size() == 0) {
    seen.swept = seen.surface.z.isNaN().select(std::nan(""), seen.swept).eval();
  }
  return seen;
}

/// The ground before as a scan before shows it, where it was not known.
SeenGround seen_before(const Surface& before, const GroundBefore& known, double offset) {
  SeenGround seen;
  seen.surface = before.height;
  seen.surface.z += offset;
  seen.deviation = before.variance.sqrt();
  keep_to_returns(before.points, known, seen);
  seen.surface.z = known.surface.isNaN().select(seen.surface.z, std::nan("")).eval();
  seen.changed.setZero(before.height.z.rows(), before.height.z.cols());
  return seen;
}

/// Four on each known cell whose centre lies in a rectangle.
std::shared_ptr<Cloud> points_on(const GroundState& ground, const Rectangle& area) {
  const HeightMap& bank = ground.terrain.bank;
  auto cloud = std::make_shared<Cloud>();
  const double quarter = 0.25 * bank.cell_size;
  for (Eigen::Index col = 0; col < bank.z.cols(); ++col) {
    const double x = bank.x(col);
    if (x < area.x_min || x > area.x_max) continue;
    for (Eigen::Index row = 0; row < bank.z.rows(); ++row) {
      const double y = bank.y(row), z = bank.z(row, col) + ground.terrain.loose(row, col);
      if (std::isnan(z) || y < area.y_min || y > area.y_max) continue;
      for (const double dx : {-quarter, quarter}) {
        for (const double dy : {-quarter, quarter}) cloud->points.emplace_back(x + dx, y + dy, z);
      }
    }
  }
  cloud->width = cloud->points.size();
  return cloud;
}

}  // namespace

Scan scan_of(const GroundState& ground, const Rectangle& near) {
  constexpr double around = 1.0;         // ours: scans are moved onto the ground by less [m]
  constexpr std::size_t fewest = 10000;  // points, ours
  constexpr double endless = std::numeric_limits<double>::infinity();
  std::shared_ptr<Cloud> cloud = points_on(
      ground, {near.x_min - around, near.y_min - around, near.x_max + around, near.y_max + around});
  if (cloud->points.size() < fewest)
    cloud = points_on(ground, {-endless, -endless, endless, endless});
  Scan scan;
  scan.clouds = {std::move(cloud)};
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
    const Eigen::ArrayXXd sd = known_or(ground.deviation, 0.0);
    known.guessed_sd = known_or(on_grid((sd > reopened_sd).select(sd, 0.0)), 0.0);
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
  const Surface& before = dig.surfaces.before;
  const GroundBefore known(*options.ground, before.height);
  const double offset = offset_of(known.surface, before.height, dig.change.areas.front());
  SeenGround after = seen_after(dig, known, offset);
  if (!options.dug_path) after.filled.resize(0, 0);  // nothing tells that it was a dig
  after.time = options.scan_time;
  std::optional<double> loose;
  if (options.soil.kind) loose = options.soil.kind->void_ratio_loose;
  const bool was_scanned = before.points.size() > 0;
  if (!was_scanned) return updated_ground(*options.ground, after, loose);
  SeenGround first = seen_before(before, known, offset);
  first.time = options.scan_time;
  return updated_ground(updated_ground(*options.ground, first), after, loose);
}

}  // namespace excavplan
