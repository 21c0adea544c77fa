// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/error.hpp>
#include <excavplan/survey/cloud.hpp>

#include "quantity.hpp"

namespace excavplan::tools {
namespace {

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
  if (!terrain.cloud) return {undisturbed(flat_ground(extent, cell)), {}};
  Cloud cloud = read_cloud(*terrain.cloud);
  if (terrain.frame) transform(cloud, read_frame(*terrain.frame));
  const Cloud near = cropped(cloud, extent);
  if (near.points.empty()) {
    throw Error(ErrorKind::bad_file,
                *terrain.cloud + ": no point lies within the machine's reach, " + text(extent) +
                    " in the site frame (origin on the swing axis at ground level, x forward); "
                    "--terrain-frame brings another frame in");
  }
  const double density = summarise(near).density;
  RasterOptions raster;
  raster.cell = std::max(cell, std::sqrt(2.0 / density));
  const HeightMap map = rasterise(near, plan_extent(near), raster);
  Site site{undisturbed(resampled(map, extent, cell)), {}};
  if (raster.cell > cell) {
    site.warnings.push_back(
        {"sparse_terrain", *terrain.cloud + ": " + readable(density, 2) +
                               " points per m2 are too few for cells of " + readable(cell, 2) +
                               " m; heights are interpolated between cells of " +
                               readable(raster.cell, 2) + " m"});
  }
  return site;
}

}  // namespace excavplan::tools
