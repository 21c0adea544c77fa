// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_survey.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <excavplan/scans/scan_terrain.hpp>

#include "ground/grid_cells.hpp"
#include "scans/return_gaps.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_pairs.hpp"
#include "scans/scan_reading.hpp"
#include "site/site_grid.hpp"
#include "site/tracks.hpp"

namespace excavplan {
namespace {

constexpr double first_sd = 0.005;  // ours: of ground that was scanned once [m]

/// Where a scan lies, and whether it can be in the unit and frame that it is taken for.
struct ScanPlace {
  Rectangle extent;
  std::vector<Warning> doubts;
};

ScanPlace place_of(const Scan& scan, unsigned threads) {
  const ScanOutline seen = outlines({scan}, threads).front();
  if (!seen.extent) throw Error(ErrorKind::bad_file, name_of(scan) + ": has no finite points");
  ScanPlace place = {*seen.extent, {}};
  if (auto doubt = check_outline(seen, scan)) place.doubts.push_back(std::move(*doubt));
  return place;
}

/// Ground about the scan, what is wide for its unit told as such.
GroundState grown_to(const ScanPlace& place, const GroundState& ground, double void_ratio) {
  return with_doubts(place.doubts, [&] { return grown(ground, place.extent, void_ratio); });
}

/// That holds the rectangle in another frame.
Rectangle moved(const Rectangle& area, const Eigen::Isometry3d& motion) {
  Eigen::AlignedBox2d box;
  for (const double x : {area.x_min, area.x_max}) {
    for (const double y : {area.y_min, area.y_max}) {
      box.extend((motion * Eigen::Vector3d(x, y, 0.0)).head<2>());
    }
  }
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

Scan moved(Scan scan, const Eigen::Isometry3d& motion) {
  scan.site_from_scan = motion.matrix() * scan.site_from_scan;
  if (scan.area) scan.area = moved(*scan.area, motion);
  return scan;
}

DensityEstimate estimate_in(const SiteEvent& event, const SiteSettings& settings,
                            const GroundState& ground) {
  DensityOptions options = event.options;
  options.soil.kind = settings.soil;
  options.ground = ground;
  options.scan_time = event.time;
  options.cell_size = std::nullopt;  // that of the ground, or a multiple
  return estimate_density({event.before.value_or(Scan{}), event.scan}, settings.law, options);
}

/// What a survey found in the frame of the machine.
struct AtMachine {
  GroundState before;
  DensityEstimate estimate;
};

/// The dig in the frame of the machine, whose path lies in the plane y = 0.
AtMachine estimate_at_machine(const SiteEvent& event, const SiteSettings& settings,
                              const GroundState& ground) {
  const Eigen::Isometry3d to_machine = event.base.site_from_machine().inverse();
  SiteEvent turned = event;
  turned.scan = moved(event.scan, to_machine);
  if (event.before) turned.before = moved(*event.before, to_machine);
  ChangeOptions& change = turned.options.change;
  if (change.dig_area) change.dig_area = moved(*change.dig_area, to_machine);
  if (change.dump_area) change.dump_area = moved(*change.dump_area, to_machine);
  const double cell = ground.terrain.bank.cell_size;
  const Rectangle extent = on_grid(moved(ground.terrain.bank.extent(), to_machine), cell);
  GroundState before = seen_by(ground, event.base, flat_ground(extent, cell));
  DensityEstimate estimate = estimate_in(turned, settings, before);
  return {std::move(before), std::move(estimate)};
}

/// Mixtures of soils keep to their range but for rounding.
void hold_void_ratios(const SoilKind& soil, Eigen::ArrayXXd& ratios) {
  ratios = (ratios > soil.void_ratio_loose).select(soil.void_ratio_loose, ratios).eval();
  ratios = (ratios < soil.void_ratio_min).select(soil.void_ratio_min, ratios).eval();
}

/// False of a scan of another place, or in another frame.
bool fits_ground(const DensityEstimate& estimate, bool dug) {
  return std::none_of(estimate.warnings.begin(), estimate.warnings.end(), [&](const Warning& each) {
    const bool is_of_place = each.code == WarningCode::frame ||
                             each.code == WarningCode::scans_do_not_fit ||
                             each.code == WarningCode::registration_beyond_prior ||
                             (dug && each.code == WarningCode::looks_swapped);
    return is_of_place && each.ends_trust;
  });
}

/// Bank that was never seen and below no obstacle.
Mask is_open(const GroundState& ground) {
  Mask open = ground.terrain.bank.z.isNaN();
  if (ground.terrain.obstacles.size() > 0) open = open && ground.terrain.obstacles.isNaN();
  return open;
}

/// Enters bank that a scan shows for the first time: where it has returns, and closely between
/// them. What a terrain fills beyond that nobody saw.
void enter(const Mask& returns, const HeightMap& shown, double time, GroundState& ground) {
  const Eigen::ArrayXXd seen = returns.select(shown.z, std::nan(""));
  const Eigen::ArrayXXd between = heights_between_returns(seen, {}, shown.cell_size);
  const Mask open = is_open(ground);
  for_each_cell(seen, [&](Cell at) {
    const auto to = cell_at(ground.terrain.bank, shown.x(at.col), shown.y(at.row));
    const bool is_filled = std::isnan(seen(at.row, at.col));
    const double z = is_filled ? between(at.row, at.col) : seen(at.row, at.col);
    if (std::isnan(z) || !to || !open(to->row, to->col)) return;
    ground.terrain.bank.z(to->row, to->col) = z;
    ground.terrain.loose(to->row, to->col) = 0.0;
    ground.seen(to->row, to->col) = time;
    ground.deviation(to->row, to->col) = is_filled ? between_returns_sd : first_sd;
  });
}

/// The cells of a map that a rectangle reaches, without heights.
HeightMap window_of(const HeightMap& map, const Rectangle& area) {
  const Rectangle whole = map.extent();
  const Rectangle near = on_grid(area, map.cell_size);
  return flat_ground({std::max(near.x_min, whole.x_min), std::max(near.y_min, whole.y_min),
                      std::min(near.x_max, whole.x_max), std::min(near.y_max, whole.y_max)},
                     map.cell_size, std::nan(""));
}

/// The other way round: where the frame of the site stands in that of the machine.
BasePose inverse(const BasePose& base) {
  const Eigen::Vector3d at = base.site_from_machine().inverse().translation();
  return {at.x(), at.y(), at.z(), -base.heading};
}

/// Where a dig changed the ground, in the frame of the machine: about the bucket's way, and where
/// soil came to lie.
std::vector<Rectangle> changed_areas(const DugPath& dug, const DensityEstimate& estimate) {
  std::vector<Rectangle> areas = {worked_area(dug)};
  for (const ChangeZone& zone : estimate.change.zones) {
    if (zone.kind == ZoneKind::dump || zone.kind == ZoneKind::spill) areas.push_back(zone.extent);
  }
  return areas;
}

/// Takes over what was found in the frame of the machine: the bank that the bucket left, and the
/// surface that the scan does not show. What the change of frames makes of the ground is in both
/// of that frame and stays out.
/// @param area    in the frame of the machine
/// @param before  of the site
void take_found(const Rectangle& area, const SiteEvent& event, const AtMachine& found,
                const GroundState& before, GroundState& ground) {
  constexpr double telling = 0.01;  // ours [m]
  Terrain& terrain = ground.terrain;
  const HeightMap grid = window_of(terrain.bank, moved(area, event.base.site_from_machine()));
  const GroundState was = seen_by(found.before, inverse(event.base), grid);
  const GroundState is = seen_by(*found.estimate.ground_after, inverse(event.base), grid);
  const Eigen::ArrayXXd sunk = is.terrain.bank.z - was.terrain.bank.z;
  const Eigen::ArrayXXd rose = sunk + is.terrain.loose - was.terrain.loose;
  for_each_cell(sunk, [&](Cell at) {
    const auto to = cell_at(terrain.bank, grid.x(at.col), grid.y(at.row));
    const auto known = cell_at(before.terrain.bank, grid.x(at.col), grid.y(at.row));
    if (!to || !known) return;
    const bool is_seen = ground.seen(to->row, to->col) == event.time;
    const double fall = sunk(at.row, at.col), rise = rose(at.row, at.col);
    if (!(std::abs(fall) > telling) && (is_seen || !(std::abs(rise) > telling))) return;
    const double bank = before.terrain.bank.z(known->row, known->col);
    const double surface = is_seen
                               ? terrain.bank.z(to->row, to->col) + terrain.loose(to->row, to->col)
                               : bank + before.terrain.loose(known->row, known->col) + rise;
    const double left = std::min(bank + fall, surface);
    if (std::isnan(left)) return;
    terrain.bank.z(to->row, to->col) = left;
    terrain.loose(to->row, to->col) = surface - left;
    terrain.loose_void_ratio(to->row, to->col) = is.terrain.loose_void_ratio(at.row, at.col);
    if (!is_seen) ground.deviation(to->row, to->col) = is.deviation(at.row, at.col);
  });
}

/// Takes in what no scan showed before. @param extent  of the scan, within the ground
void add_new_ground(const Scan& scan, const Rectangle& extent, double time, GroundState& ground) {
  const HeightMap window = window_of(ground.terrain.bank, extent);
  const Mask returns = returns_in(scan, window);
  const Mask open = is_open(ground);
  bool is_news = false;
  for_each_cell(returns, [&](Cell at) {
    if (!returns(at.row, at.col) || is_news) return;
    const auto to = cell_at(ground.terrain.bank, window.x(at.col), window.y(at.row));
    is_news = to && open(to->row, to->col);
  });
  if (!is_news) return;
  enter(returns, terrain_from_scan(scan, window.extent(), window.cell_size).terrain.bank, time,
        ground);
}

}  // namespace

Mask returns_in(const Scan& scan, const HeightMap& grid) {
  Mask returns = Mask::Constant(grid.z.rows(), grid.z.cols(), false);
  visit_scan(scan, [&](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) {
      if (const auto cell = cell_at(grid, point.x(), point.y()))
        returns(cell->row, cell->col) = true;
    }
  });
  return returns;
}

GroundState first_ground(const Scan& scan, double time, const SiteSettings& settings,
                         std::vector<Warning>& warnings) {
  const double fresh = settings.soil.void_ratio_loose;
  const ScanPlace place = place_of(scan, 0);
  // All later scans are compared with the first one.
  if (!place.doubts.empty())
    throw Error(ErrorKind::bad_file, "the first scan of the site: " + place.doubts.front().message);
  GroundState ground = unseen_ground(place.extent, *settings.cell_size, fresh);
  const HeightMap& grid = ground.terrain.bank;
  ScannedTerrain scanned = terrain_from_scan(scan, grid.extent(), grid.cell_size);
  Terrain seen = std::move(scanned.terrain);
  // Its extent is a rectangle, of which no scan need show all.
  std::copy_if(scanned.warnings.begin(), scanned.warnings.end(), std::back_inserter(warnings),
               [](const Warning& each) { return each.code != WarningCode::unseen_ground; });
  if (seen.obstacles.size() > 0) ground.terrain.obstacles = std::move(seen.obstacles);
  enter(returns_in(scan, seen.bank), seen.bank, time, ground);
  ground.frame = settings.frame;
  ground.soil = settings.soil.name;
  return ground;
}

SurveyedEvent surveyed(const SiteEvent& event, const SiteSettings& settings,
                       const GroundState& before) {
  const ScanPlace place = place_of(event.scan, event.options.threads);
  GroundState ground = grown_to(place, before, settings.soil.void_ratio_loose);
  SurveyedEvent result;
  const bool is_apart = event.dug && event.options.dug_path && !event.base.is_origin();
  SiteEvent in_site = event;
  if (is_apart && event.options.dug_path->start_x) {
    in_site.options.worked_area =
        moved(worked_area(*event.options.dug_path), event.base.site_from_machine());
  }
  if (const auto heap = is_apart ? heap_area(*event.options.dug_path) : std::nullopt) {
    in_site.options.change.heap_near = moved(*heap, event.base.site_from_machine());
  }
  if (is_apart) in_site.options.dug_path = std::nullopt;
  if (is_apart) in_site.options.joint_work = std::nullopt;
  DensityEstimate estimate = estimate_in(in_site, settings, ground);
  result.fits = fits_ground(estimate, event.dug);
  if (estimate.registration) {
    result.alignment = estimate.registration->found;
    result.correction = estimate.registration->correction;
  }
  if (result.fits) {
    result.ground = std::move(*estimate.ground_after);
    const auto& moved_by = estimate.registration;
    add_new_ground(moved_by ? corrected(event.scan, moved_by->correction) : event.scan,
                   place.extent, event.time, result.ground);
    if (is_apart) {
      AtMachine found = estimate_at_machine(event, settings, ground);
      if (event.options.dug_path->start_x && found.estimate.ground_after) {
        for (const Rectangle& area : changed_areas(*event.options.dug_path, found.estimate)) {
          take_found(area, event, found, ground, result.ground);
        }
      }
      estimate = std::move(found.estimate);
    }
  } else {
    result.ground = std::move(ground);
  }
  hold_void_ratios(settings.soil, result.ground.terrain.loose_void_ratio);
  if (result.fits && event.dug) {
    compact_under_tracks(settings, event.base, event.time, result.ground);
  }
  result.warnings = estimate.warnings;
  if (event.dug) result.estimate = std::move(estimate);
  return result;
}

}  // namespace excavplan
