// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/scan_terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <excavplan/ground/resampling.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

// Gaps in a scan up to so wide are filled [m], and [cells]; ours.
constexpr double widest_filled = 0.3;
constexpr double widest_filled_cells = 3.0;
constexpr std::size_t fewest_points = 10;  // that make a ground; ours

// Of ground that nothing may hit [m]; ours: a wall may stand between points that are further apart.
constexpr double motion_cell = 0.25, motion_farthest = 0.5;

// Of two scans of the same ground; ours.
constexpr double same_height = 0.15;         // [m]
constexpr double least_same = 0.2;           // of the cells that both know
constexpr Eigen::Index fewest_common = 100;  // cells that are compared

/// Points of the extent, with a metre around it to interpolate from, all as if seen from one place.
Scan cropped(const Scan& scan, const Rectangle& extent) {
  constexpr double around = 1.0;
  constexpr double endless = std::numeric_limits<double>::infinity();
  const Rectangle area = scan.area.value_or(Rectangle{-endless, -endless, endless, endless});
  Scan inside = scan;
  inside.area = {
      std::max(extent.x_min - around, area.x_min), std::max(extent.y_min - around, area.y_min),
      std::min(extent.x_max + around, area.x_max), std::min(extent.y_max + around, area.y_max)};
  inside.sensor_origin = scan.sensor_origin.value_or(Eigen::Vector3d::Zero());
  return inside;
}

bool is_empty(const Rectangle& r) { return !(r.x_max > r.x_min && r.y_max > r.y_min); }

std::string text(const Rectangle& r) {
  return "x = " + readable(r.x_min) + " .. " + readable(r.x_max) + " m, y = " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

void require_width(const Scan& scan, const Rectangle& seen) {
  constexpr double dense = std::numeric_limits<double>::infinity();
  const auto narrow = doubt_of_extent(seen, dense, scan.unit);
  if (narrow) throw FrameError(name_of(scan) + ": " + narrow->message);
}

void require_points(const Scan& scan, std::size_t points, const Rectangle& extent) {
  if (points >= fewest_points) return;
  const ScanOutline all = outline(scan);
  const auto unit =
      all.extent ? doubt_of_extent(*all.extent, all.density, scan.unit) : std::nullopt;
  throw FrameError(
      name_of(scan) + ": " +
      (points == 0 ? "no point lies" : "only " + std::to_string(points) + " points lie") +
      " within the machine's reach, " + text(extent) +
      " in the site frame (origin on the swing axis at ground level, x forward)" +
      (unit ? "; " + unit->message : ""));
}

/// The second where the first is unknown.
Terrain filled_from(const Terrain& first, const Terrain& second) {
  HeightMap ground = first.surface();
  ground.z = ground.z.isFinite().select(ground.z, second.surface().z).eval();
  return undisturbed(ground);
}

/// What a scan shows of an extent.
struct Seen {
  Scan near;
  Rectangle extent;
  double density;  ///< points per m^2
};

Seen seen_of(const Scan& scan, const Rectangle& extent) {
  const Scan near = cropped(scan, extent);
  const CloudSummary seen = is_empty(*near.area) ? CloudSummary{} : summarise(near);
  require_points(scan, seen.finite_points, extent);
  require_width(scan, *seen.extent);
  return {near, *seen.extent, seen.density};
}

/// Two points lie in such a cell [m].
double cell_of(const Seen& seen) { return std::sqrt(2.0 / seen.density); }

Terrain ground_of(const Seen& seen, double raster_cell, double widest_gap, const Rectangle& extent,
                  double cell_size) {
  RasterOptions raster;
  raster.cell_size = raster_cell;
  const HeightMap map = survey_surface(seen.near, seen.extent, raster).height;
  return undisturbed(resampled(map, extent, cell_size, widest_gap));
}

}  // namespace

ScannedTerrain terrain_from_scan(const Scan& scan, const Rectangle& extent, double cell_size) {
  require(cell_size > 0.0 && std::isfinite(cell_size), "terrain from a scan: cell_size", cell_size,
          "> 0 m and finite");
  const Seen seen = seen_of(scan, extent);
  const double cell = std::max(cell_size, cell_of(seen));
  const double widest_gap = std::max(widest_filled, widest_filled_cells * cell);
  ScannedTerrain result{ground_of(seen, cell, widest_gap, extent, cell_size), scan.doubts};
  if (const double unseen = unseen_area(result.terrain.bank); unseen > 0.0) {
    result.warnings.emplace_back(WarningCode::unseen_ground,
                                 name_of(scan) + ": the scan does not see " + readable(unseen, 2) +
                                     " m2 of the ground within reach, in gaps wider than " +
                                     readable(widest_gap, 2) + " m; no dig is planned there");
  }
  if (cell > cell_size) {
    result.warnings.emplace_back(
        WarningCode::sparse_terrain,
        name_of(scan) + ": " + readable(seen.density, 2) +
            " points per m2 are too few for cells of " + readable(cell_size, 2) +
            " m; heights are interpolated between cells of " + readable(cell, 2) + " m");
  }
  return result;
}

ScannedTerrain swing_terrain_from_scan(const Scan& scan, const Machine& machine) {
  const Rectangle extent = swing_extent(machine);
  const double cell_size = usual_cell(machine);
  const Seen seen = seen_of(scan, extent);
  const auto ground_on = [&](double smallest) {
    const double cell = std::max(cell_size, smallest);
    const double widest_gap = std::clamp(motion_farthest - 2.0 * cell, 0.0, widest_filled);
    return ground_of(seen, cell, widest_gap, extent, cell_size);
  };
  ScannedTerrain result{ground_on(std::min(cell_of(seen), motion_cell)), scan.doubts};
  // Lines of points are dense, and yet apart.
  const bool is_whole = result.terrain.bank.z.isFinite().all();
  if (!is_whole) result.terrain = filled_from(result.terrain, ground_on(motion_cell));
  return result;
}

HeightMap standing_ground_from_scan(const Scan& scan, const Machine& machine) {
  const Rectangle extent = standing_extent(machine);
  const double cell_size = 2.0 * usual_cell(machine);
  try {
    return terrain_from_scan(scan, extent, cell_size).terrain.surface();
  } catch (const FrameError&) {  // a scan of the ground ahead alone
    return flat_ground(extent, cell_size, std::nan(""));
  }
}

ScannedTerrain with_surroundings(const Terrain& present, const Terrain& earlier) {
  const HeightMap ground = present.surface();
  const HeightMap around = earlier.surface();
  require(same_grid(ground, around), "surroundings: must have the cells of the present ground");
  const auto both = ground.z.isFinite() && around.z.isFinite();
  const Eigen::Index common = both.count();
  const Eigen::Index same = (both && (ground.z - around.z).abs() <= same_height).count();
  std::vector<Warning> warnings;
  if (common >= fewest_common &&
      static_cast<double>(same) < least_same * static_cast<double>(common)) {
    warnings.emplace_back(
        WarningCode::surroundings_differ,
        "of the ground that the present scan and that of the surroundings both "
        "show only " +
            readable(100.0 * static_cast<double>(same) / static_cast<double>(common), 2) +
            " % has the same height: is one in another frame?");
  }
  return {filled_from(present, earlier), std::move(warnings)};
}

}  // namespace excavplan
