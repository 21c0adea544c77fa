// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/error.hpp>

#include "quantity.hpp"

namespace excavplan::tools {
namespace {

/// A scan and how dense it is.
struct Scan {
  Cloud cloud;
  double density = 0.0;
};

Scan read_in_site_frame(const std::string& file, const std::optional<std::string>& frame,
                        const std::optional<Rectangle>& area) {
  Cloud cloud = read_cloud(file);
  if (frame) transform(cloud, read_frame(*frame));
  if (area) {
    const auto outside = [&](const Eigen::Vector3d& p) { return !area->contains(p.x(), p.y()); };
    cloud.points.erase(std::remove_if(cloud.points.begin(), cloud.points.end(), outside),
                       cloud.points.end());
    cloud.width = cloud.points.size();
    cloud.height = 1;
  }
  const CloudSummary summary = summarise(cloud);
  if (summary.finite_points < 100) {
    throw Error(ErrorKind::bad_file,
                file + ": holds fewer than 100 finite points" + (area ? " inside --area" : ""));
  }
  return {std::move(cloud), summary.density};
}

std::string text(const Rectangle& r) {
  return "x " + readable(r.x_min) + " .. " + readable(r.x_max) + ", y " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

Rectangle overlap(const ScanPair& scans) {
  constexpr double least = 0.2;  // [m], ours
  const Rectangle a = plan_extent(scans.before);
  const Rectangle b = plan_extent(scans.after);
  const Rectangle both = {std::max(a.x_min, b.x_min), std::max(a.y_min, b.y_min),
                          std::min(a.x_max, b.x_max), std::min(a.y_max, b.y_max)};
  if (!(both.x_max - both.x_min > least && both.y_max - both.y_min > least)) {
    throw Error(ErrorKind::bad_file, scans.before_file + " and " + scans.after_file +
                                         " do not overlap: " + text(a) + " and " + text(b) +
                                         "; --before-frame and --after-frame bring them into one "
                                         "frame");
  }
  return both;
}

}  // namespace

ScanPair read_scans(const std::string& before, const std::string& after, const ScanFrames& frames) {
  Scan first = read_in_site_frame(before, frames.before, frames.area);
  Scan second = read_in_site_frame(after, frames.after, frames.area);
  return {before, after, std::move(first.cloud), std::move(second.cloud),
          std::min(first.density, second.density)};
}

double cell_for(const ScanPair& scans) { return std::max(0.05, std::sqrt(6.0 / scans.density)); }

SurfacePair surfaces(const ScanPair& scans, double cell) {
  RasterOptions raster;
  raster.cell = cell;
  const Rectangle extent = overlap(scans);
  return {rasterise(scans.before, extent, raster), rasterise(scans.after, extent, raster)};
}

}  // namespace excavplan::tools
