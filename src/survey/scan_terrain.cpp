// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/survey/scan_terrain.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.hpp"
#include "base/text.hpp"
#include "survey/scan_reading.hpp"

namespace excavplan {
namespace {

// Gaps in a scan up to so wide are filled [m], and [cells]; ours.
constexpr double widest_filled = 0.3;
constexpr double widest_filled_cells = 3.0;
constexpr std::size_t fewest_points = 10;  // that make a ground; ours

/// Points of the extent, with a metre around it to interpolate from.
Cloud cropped(const Scan& scan, Rectangle extent) {
  extent = {extent.x_min - 1.0, extent.y_min - 1.0, extent.x_max + 1.0, extent.y_max + 1.0};
  Cloud inside;
  visit_scan(scan, [&](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& p : points) {
      if (p.allFinite() && extent.contains(p.x(), p.y())) inside.points.push_back(p);
    }
  });
  inside.width = inside.points.size();
  return inside;
}

std::string text(const Rectangle& r) {
  return "x = " + readable(r.x_min) + " .. " + readable(r.x_max) + " m, y = " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

void require_points(const Scan& scan, std::size_t points, const Rectangle& extent) {
  if (points >= fewest_points) return;
  throw FrameError(
      name_of(scan) + ": " +
      (points == 0 ? "no point lies" : "only " + std::to_string(points) + " points lie") +
      " within the machine's reach, " + text(extent) +
      " in the site frame (origin on the swing axis at ground level, x forward)");
}

}  // namespace

ScannedTerrain terrain_from_scan(const Scan& scan, const Rectangle& extent, double cell_size) {
  require(cell_size > 0.0 && std::isfinite(cell_size), "terrain from a scan: cell_size", cell_size,
          "> 0 m and finite");
  const Cloud near = cropped(scan, extent);
  require_points(scan, near.points.size(), extent);
  const double density = summarise(near).density;
  RasterOptions raster;
  raster.cell_size = std::max(cell_size, std::sqrt(2.0 / density));
  const HeightMap map = rasterise(near, plan_extent(near), raster);
  const double widest_gap = std::max(widest_filled, widest_filled_cells * raster.cell_size);
  ScannedTerrain result{undisturbed(resampled(map, extent, cell_size, widest_gap)), {}};
  result.warnings = scan.doubts;
  if (const double unseen = unseen_area(result.terrain.bank); unseen > 0.0) {
    result.warnings.push_back(
        {"unseen_ground", name_of(scan) + ": the scan does not see " + readable(unseen, 2) +
                              " m2 of the ground within reach, in gaps wider than " +
                              readable(widest_gap, 2) + " m; no dig is planned there"});
  }
  if (raster.cell_size > cell_size) {
    result.warnings.push_back(
        {"sparse_terrain", name_of(scan) + ": " + readable(density, 2) +
                               " points per m2 are too few for cells of " + readable(cell_size, 2) +
                               " m; heights are interpolated between cells of " +
                               readable(raster.cell_size, 2) + " m"});
  }
  return result;
}

}  // namespace excavplan
