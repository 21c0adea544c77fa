// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/site.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/error.hpp>
#include <excavplan/survey/cloud.hpp>

#include "base/text.hpp"
#include "shared/quantity.hpp"

namespace excavplan::tools {
namespace {

// Gaps in a scan up to so wide are filled [m], and [cells]; ours.
constexpr double widest_filled = 0.3;
constexpr double widest_filled_cells = 3.0;
constexpr std::size_t fewest_points = 10;  // that make a ground; ours

/// Points of the extent, with a metre around it to interpolate from.
Cloud cropped(const Cloud& cloud, Rectangle extent) {
  extent = {extent.x_min - 1.0, extent.y_min - 1.0, extent.x_max + 1.0, extent.y_max + 1.0};
  Cloud inside;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (p.allFinite() && extent.contains(p.x(), p.y())) inside.points.push_back(p);
  }
  inside.width = inside.points.size();
  return inside;
}

std::string text(const Rectangle& r) {
  return "x = " + readable(r.x_min) + " .. " + readable(r.x_max) + " m, y = " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

}  // namespace

Site make_site(const TerrainInput& terrain, const Rectangle& extent, double cell) {
  if (terrain.frame && !terrain.cloud) {
    throw Error(ErrorKind::bad_input, "--terrain-frame goes with --terrain");
  }
  if (!(cell >= finest_cell && cell <= coarsest_cell)) {
    throw Error(ErrorKind::bad_input, "--cell: the cell is " + number_text(cell) +
                                          " m, must be in " + number_text(finest_cell) + " .. " +
                                          number_text(coarsest_cell) + " m");
  }
  if (!terrain.cloud) return {undisturbed(flat_ground(extent, cell)), {}};
  Cloud cloud = read_cloud(*terrain.cloud);
  if (terrain.frame) transform(cloud, read_frame(*terrain.frame));
  const Cloud near = cropped(cloud, extent);
  if (near.points.size() < fewest_points) {
    throw Error(
        ErrorKind::bad_file,
        *terrain.cloud + ": " +
            (near.points.empty() ? "no point lies"
                                 : "only " + std::to_string(near.points.size()) + " points lie") +
            " within the machine's reach, " + text(extent) +
            " in the site frame (origin on the swing axis at ground level, x forward); "
            "--terrain-frame brings another frame in");
  }
  const double density = summarise(near).density;
  RasterOptions raster;
  raster.cell_size = std::max(cell, std::sqrt(2.0 / density));
  const HeightMap map = rasterise(near, plan_extent(near), raster);
  const double widest_gap = std::max(widest_filled, widest_filled_cells * raster.cell_size);
  Site site{undisturbed(resampled(map, extent, cell, widest_gap)), {}};
  if (const double unseen = unseen_area(site.ground.bank); unseen > 0.0) {
    site.warnings.push_back(
        {"unseen_ground", *terrain.cloud + ": the scan does not see " + readable(unseen, 2) +
                              " m2 of the ground within reach, in gaps wider than " +
                              readable(widest_gap, 2) + " m; no dig goes there"});
  }
  if (raster.cell_size > cell) {
    site.warnings.push_back(
        {"sparse_terrain", *terrain.cloud + ": " + readable(density, 2) +
                               " points per m2 are too few for cells of " + readable(cell, 2) +
                               " m; heights are interpolated between cells of " +
                               readable(raster.cell_size, 2) + " m"});
  }
  return site;
}

}  // namespace excavplan::tools
