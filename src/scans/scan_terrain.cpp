// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/scan_terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <excavplan/ground/resampling.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "scans/scan_agreement.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_obstacles.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

// Gaps in a scan up to so wide are filled [m], and [cells]; ours.
constexpr double widest_filled = 0.3;
constexpr double widest_filled_cells = 3.0;
constexpr std::size_t fewest_of_ground = 10;  // that make a ground; ours
constexpr double narrowest = 1e-3;            // that makes a ground; ours [m]

// Of ground that nothing may hit [m]; ours: a wall may stand between points that are further apart.
constexpr double motion_cell = 0.25, motion_farthest = 0.5;
constexpr double above_reach = 0.5;  // what is higher is in nobody's way

constexpr double dig_ceiling = 20.0;  // of what may stand in the way of a dig; ours [m]

constexpr double enough_for_two = 40.0;  // points, that two surfaces are told by; ours

constexpr double interpolated = 1.0, shaped = 3.5;  // around an extent; ours [m]

/// The scan without its points that hold no data.
Scan of_data(const Scan& scan, std::optional<Warning>* told = nullptr) {
  const ScanOutline seen = outline(scan);
  if (told != nullptr) *told = check_no_data(seen, scan);
  Scan rest = scan;
  rest.no_data.insert(rest.no_data.end(), seen.no_data.begin(), seen.no_data.end());
  return rest;
}

/// Points of the extent, with so much around it, all as if seen from one place.
Scan cropped(const Scan& scan, const Rectangle& extent, double around) {
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

std::string text_of(const Rectangle& r) {
  return "x = " + readable(r.x_min) + " .. " + readable(r.x_max) + " m, y = " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

void require_width(const Scan& scan, const Rectangle& seen) {
  constexpr double dense = std::numeric_limits<double>::infinity();
  const auto narrow = doubt_of_extent(seen, dense, scan.unit);
  if (narrow) throw FrameError(name_of(scan) + ": " + narrow->message);
  if (std::min(seen.x_max - seen.x_min, seen.y_max - seen.y_min) >= narrowest) return;
  throw FrameError(name_of(scan) + ": the points within the machine's reach lie on a line, " +
                   text_of(seen) + ", must spread over " + readable(narrowest) +
                   " m or more in both directions");
}

void require_heights(const Scan& scan, const HeightMap& map) {
  const double farthest = map.z.isNaN().select(0.0, map.z.abs()).maxCoeff();
  if (farthest <= farthest_height) return;
  throw FrameError(name_of(scan) + ": a height of the ground is " + readable(farthest) +
                   " m from 0, must be at most " + readable(farthest_height) + " m");
}

void require_points(const Scan& scan, std::size_t points, const Rectangle& extent) {
  if (points >= fewest_of_ground) return;
  const ScanOutline all = outline(scan);
  const auto unit =
      all.extent ? doubt_of_extent(*all.extent, all.density, scan.unit) : std::nullopt;
  throw FrameError(
      name_of(scan) + ": " +
      (points == 0 ? "no point lies" : "only " + std::to_string(points) + " points lie") +
      " within the machine's reach, " + text_of(extent) +
      " in the site frame (origin on the swing axis at ground level, x forward)" +
      (unit ? "; " + unit->message : ""));
}

/// The second where the first is unknown.
HeightMap filled_from(const HeightMap& first, const HeightMap& second) {
  HeightMap ground = first;
  ground.z = ground.z.isFinite().select(ground.z, second.z).eval();
  return ground;
}

/// Ground with what stands on it, below which none is seen.
Terrain terrain_with(HeightMap ground, const SeenTops& tops) {
  ground.z = tops.obstacles.isFinite().select(std::nan(""), ground.z).eval();
  Terrain terrain = undisturbed(ground);
  if (!tops.obstacles.isFinite().any()) return terrain;
  terrain.obstacles = tops.obstacles;
  terrain.obstacle_returns = tops.returns;
  terrain.thin_obstacles = tops.thin;
  return terrain;
}

/// What stands on a terrain, on all of its cells.
SeenTops tops_of(const Terrain& terrain) {
  const auto rows = terrain.bank.z.rows(), cols = terrain.bank.z.cols();
  SeenTops tops;
  const bool any = terrain.obstacles.size() > 0;
  tops.obstacles = any ? terrain.obstacles : Eigen::ArrayXXd::Constant(rows, cols, std::nan(""));
  const bool has_returns = terrain.obstacle_returns.size() > 0;
  tops.returns = has_returns ? terrain.obstacle_returns : tops.obstacles;
  const bool has_thin = terrain.thin_obstacles.size() > 0;
  tops.thin = has_thin ? terrain.thin_obstacles : CellMask::Constant(rows, cols, false);
  return tops;
}

/// With what stood on the earlier ground where the present one is unknown, or where it is so thin
/// that the present scan need not have hit it. What else stood where now is ground has gone.
SeenTops tops_of_both(const Terrain& present, const Terrain& earlier) {
  SeenTops tops = tops_of(present);
  const SeenTops before = tops_of(earlier);
  const CellMask none = tops.obstacles.isNaN();
  const CellMask stay =
      none && !before.obstacles.isNaN() && (present.highest().z.isNaN() || before.thin);
  tops.obstacles = stay.select(before.obstacles, tops.obstacles).eval();
  tops.returns = stay.select(before.returns, tops.returns).eval();
  tops.thin = (tops.thin || (stay && before.thin)).eval();
  return tops;
}

/// What a scan shows of an extent.
struct Seen {
  Scan near;
  Rectangle extent;
  double density;  ///< points per m^2
};

Seen seen_of(const Scan& scan, const Rectangle& extent) {
  const Scan near = cropped(scan, extent, interpolated);
  const CloudSummary seen = is_empty(*near.area) ? CloudSummary{} : summarise(near);
  require_points(scan, seen.finite_points, extent);
  require_width(scan, *seen.extent);
  return {near, *seen.extent, seen.density};
}

/// Two points lie in such a cell [m].
double cell_of(const Seen& seen) { return std::sqrt(2.0 / seen.density); }

Surface surface_of(const Seen& seen, double raster_cell) {
  RasterOptions raster;
  raster.cell_size = raster_cell;
  Surface surface = survey_surface(seen.near, seen.extent, raster);
  require_heights(seen.near, surface.height);
  return surface;
}

/// Code `two_surfaces` for ground but not for what stands on it, which is an obstacle.
std::optional<Warning> overlaid(const std::string& name, const Surface& surface,
                                const Terrain& terrain) {
  constexpr double least = 0.02;     // of a height in doubt; ours [m]
  constexpr double noted = 0.01;     // of the ground; ours, as of a bulking factor
  constexpr double doubtful = 0.03;  // likewise
  const HeightMap& map = surface.height;
  double seen = 0.0, in_doubt = 0.0, doubt = 0.0;
  for_each_cell(map.z, [&](Cell at) {
    const auto cell = cell_at(terrain.bank, map.x(at.col), map.y(at.row));
    if (!cell || std::isnan(map.z(at.row, at.col))) return;
    if (terrain.obstacles.size() > 0 && !std::isnan(terrain.obstacles(cell->row, cell->col)))
      return;
    seen += 1.0;
    const auto here = static_cast<double>(surface.doubt(at.row, at.col));
    if (here < least) return;
    in_doubt += 1.0;
    doubt += here;
  });
  if (!(in_doubt > noted * seen)) return std::nullopt;
  return Warning{WarningCode::two_surfaces,
                 name + ": the points on " + readable(in_doubt * map.cell_size * map.cell_size, 2) +
                     " m2 of the ground within reach lie on two surfaces, one above the other, "
                     "which leaves " +
                     readable(doubt / in_doubt, 2) +
                     " m of its height in doubt: check the poses of the scans that are joined in "
                     "it, and leave out dust, plants and what else is above the ground",
                 in_doubt > doubtful * seen};
}

/// Where the machine stands that digs on an extent.
Rectangle behind(const Rectangle& extent) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  return {-endless, -endless, extent.x_min, endless};
}

/// Of a machine where it stands, facing the dig: tracks and upper structure.
Rectangle own_place(const Machine& machine) {
  constexpr double rounded = 0.05;  // of returns of its sides; ours [m]
  const double front = std::max(0.0, machine.track_front) + rounded;
  const double rear = std::max(front, machine.tail_swing_radius() + rounded);
  const double half = 0.5 * machine.undercarriage_width() + rounded;
  return {-rear, -half, front, half};
}

/// The ground of an extent and what stands on it.
struct GroundOfScan {
  GroundOfScan(const Scan& scan, const Rectangle& extent, double cell_size)
      : points(seen_of(scan, extent)),
        cell(std::max(cell_size, cell_of(points))),
        widest_gap(std::max(widest_filled, widest_filled_cells * cell)),
        surface(surface_of(points, cell)),
        ground(resampled(surface.height, extent, cell_size, widest_gap)),
        terrain(terrain_with(ground, seen_tops(cropped(scan, extent, shaped), ground,
                                               {cell_of(points), dig_ceiling, behind(extent)}))) {}

  Seen points;
  double cell;        ///< of the survey [m]
  double widest_gap;  ///< over which heights are interpolated [m]
  Surface surface;
  HeightMap ground;
  Terrain terrain;
};

}  // namespace

ScannedTerrain terrain_from_scan(const Scan& scan, const Rectangle& extent, double cell_size) {
  require(cell_size > 0.0 && std::isfinite(cell_size), "terrain from a scan: cell_size", cell_size,
          "> 0 m and finite");
  std::optional<Warning> no_data;
  const Scan data = of_data(scan, &no_data);
  const GroundOfScan seen(data, extent, cell_size);
  ScannedTerrain result{seen.terrain, data.doubts};
  if (no_data) result.warnings.push_back(std::move(*no_data));
  const double wide = std::sqrt(enough_for_two / seen.points.density);
  const Surface& tested = wide > seen.cell ? surface_of(seen.points, wide) : seen.surface;
  if (auto both = overlaid(name_of(data), tested, result.terrain)) {
    result.warnings.push_back(std::move(*both));
  }
  if (const double unseen = unseen_area(seen.ground); unseen > 0.0) {
    result.warnings.emplace_back(WarningCode::unseen_ground,
                                 name_of(data) + ": the scan does not see " + readable(unseen, 2) +
                                     " m2 of the ground within reach, in gaps wider than " +
                                     readable(seen.widest_gap, 2) + " m; no dig is planned there");
  }
  if (seen.cell > cell_size) {
    result.warnings.emplace_back(
        WarningCode::sparse_terrain,
        name_of(data) + ": " + readable(seen.points.density, 2) +
            " points per m2 are too few for cells of " + readable(cell_size, 2) +
            " m; heights are interpolated between cells of " + readable(seen.cell, 2) + " m");
  }
  result.terrain.doubts = result.warnings;
  return result;
}

ScannedTerrain swing_terrain_from_scan(const Scan& scan, const Machine& machine) {
  const Scan data = of_data(scan);
  const Rectangle extent = swing_extent(machine);
  const double cell_size = usual_cell(machine);
  const Seen seen = seen_of(data, extent);
  const auto ground_on = [&](double smallest) {
    const double cell = std::max(cell_size, smallest);
    const double widest_gap = std::clamp(motion_farthest - 2.0 * cell, 0.0, widest_filled);
    return resampled(surface_of(seen, cell).height, extent, cell_size, widest_gap);
  };
  HeightMap ground = ground_on(std::min(cell_of(seen), motion_cell));
  // Lines of points are dense, and yet apart.
  if (!ground.z.isFinite().all()) ground = filled_from(ground, ground_on(motion_cell));
  const double ceiling = machine.boom_pin.y() + machine.full_length() + above_reach;
  const SeenTops tops = seen_tops(cropped(data, extent, shaped), ground,
                                  {cell_of(seen), ceiling, own_place(machine)});
  ground.z = (tops.highest > ground.z || ground.z.isNaN()).select(tops.highest, ground.z).eval();
  return {terrain_with(std::move(ground), tops), data.doubts};
}

HeightMap standing_ground_from_scan(const Scan& scan, const Machine& machine) {
  const Rectangle extent = standing_extent(machine);
  const double cell_size = 2.0 * usual_cell(machine);
  try {
    return GroundOfScan(of_data(scan), extent, cell_size).terrain.surface();
  } catch (const FrameError&) {  // a scan of the ground ahead alone
    return flat_ground(extent, cell_size, std::nan(""));
  }
}

ScannedTerrain with_surroundings(const Terrain& present, const Terrain& earlier) {
  const HeightMap ground = present.surface(), around = earlier.surface();
  require(same_grid(ground, around), "surroundings: must have the cells of the present ground");
  const HeightMap now = present.highest(), before = earlier.highest();
  std::vector<Warning> warnings;
  if (const auto why = disagreement(now, before)) {
    warnings.emplace_back(WarningCode::surroundings_differ, *why + ": is one in another frame?");
  }
  return {terrain_with(filled_from(ground, around), tops_of_both(present, earlier)),
          std::move(warnings)};
}

Terrain with_earlier_obstacles(const Terrain& present, const Terrain& earlier) {
  require(same_grid(present.bank, earlier.bank),
          "earlier obstacles: must have the cells of the present ground");
  Terrain both = present;
  const SeenTops tops = tops_of_both(present, earlier);
  Terrain with = terrain_with(present.bank, tops);
  both.bank = std::move(with.bank);
  both.obstacles = std::move(with.obstacles);
  both.obstacle_returns = std::move(with.obstacle_returns);
  both.thin_obstacles = std::move(with.thin_obstacles);
  return both;
}

}  // namespace excavplan
