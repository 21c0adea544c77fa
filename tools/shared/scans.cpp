// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/scans.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <excavplan/error.hpp>

#include "shared/quantity.hpp"

namespace excavplan::tools {
namespace {

Scan scan_of(const std::string& file, const std::optional<std::string>& frame,
             const std::optional<Rectangle>& area) {
  Scan scan;
  scan.files = {file};
  if (frame) scan.site_from_scan = read_frame(*frame);
  scan.area = area;
  return scan;
}

void require_points(const SeenScan& seen) {
  if (seen.outline.finite_points >= 100) return;
  throw Error(ErrorKind::bad_file, seen.file() + ": holds fewer than 100 finite points" +
                                       (seen.scan.area ? " inside --area" : ""));
}

std::string text(const Rectangle& r) {
  return "x " + readable(r.x_min) + " .. " + readable(r.x_max) + ", y " + readable(r.y_min) +
         " .. " + readable(r.y_max) + " m";
}

Rectangle overlap(const SeenPair& scans) {
  constexpr double least = 0.2;  // [m], ours
  const Rectangle& a = *scans.before.outline.extent;
  const Rectangle& b = *scans.after.outline.extent;
  const Rectangle both = {std::max(a.x_min, b.x_min), std::max(a.y_min, b.y_min),
                          std::min(a.x_max, b.x_max), std::min(a.y_max, b.y_max)};
  if (!(both.x_max - both.x_min > least && both.y_max - both.y_min > least)) {
    throw Error(ErrorKind::bad_file, scans.before.file() + " and " + scans.after.file() +
                                         " do not overlap: " + text(a) + " and " + text(b) +
                                         "; --before-frame and --after-frame bring them into one "
                                         "frame");
  }
  return both;
}

}  // namespace

Cloud SeenScan::cloud() const {
  Cloud cloud = read_cloud(file());
  transform(cloud, scan.site_from_scan);
  if (scan.area) {
    const auto outside = [this](const Eigen::Vector3d& p) {
      return !scan.area->contains(p.x(), p.y());
    };
    cloud.points.erase(std::remove_if(cloud.points.begin(), cloud.points.end(), outside),
                       cloud.points.end());
    cloud.width = cloud.points.size();
    cloud.height = 1;
  }
  return cloud;
}

SeenPair read_scans(const std::string& before, const std::string& after, const ScanFrames& frames) {
  std::vector<Scan> scans = {scan_of(before, frames.before, frames.area),
                             scan_of(after, frames.after, frames.area)};
  const std::vector<ScanOutline> seen = outlines(scans);
  SeenPair pair{{std::move(scans[0]), seen[0]}, {std::move(scans[1]), seen[1]}};
  require_points(pair.before);
  require_points(pair.after);
  return pair;
}

double cell_for(const SeenPair& scans) {
  return excavplan::cell_for({scans.before.outline, scans.after.outline});
}

RegisteredPair surveyed(const SeenPair& scans, double cell, bool align_them) {
  RasterOptions raster;
  raster.cell_size = cell;
  const Rectangle extent = overlap(scans);
  const Scan& before = scans.before.scan;
  const Scan& after = scans.after.scan;
  if (align_them) return survey_registered({before, after}, extent, raster, cell_for(scans));
  std::vector<Surface> both = survey_surfaces({before, after}, extent, raster);
  RegisteredPair pair;
  pair.surfaces.before = std::move(both[0]);
  pair.surfaces.after = std::move(both[1]);
  return pair;
}

HeightMapPair surfaces(const SeenPair& scans, double cell) {
  SurfacePair pair = surveyed(scans, cell, false).surfaces;
  return {std::move(pair.before.height), std::move(pair.after.height)};
}

}  // namespace excavplan::tools
