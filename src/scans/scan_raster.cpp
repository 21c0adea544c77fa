// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <excavplan/scans/scan_surface.hpp>

#include "base/parallel.hpp"
#include "clouds/cloud_raster.hpp"
#include "ground/sight_lines.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

/// What one standpoint saw: its points that count, and the space that they show to be empty.
struct View {
  Eigen::ArrayXXi dropped;  ///< 1 for cells whose returns are mixed or that it saw in part
  Eigen::ArrayXXi seen;     ///< 1 for cells that it saw
  Eigen::ArrayXXd ceiling;  ///< of ground, by its rays [m]
};

View view_from(const Standpoint& from, const HeightMap& map, const RasterOptions& options) {
  const PointSource source = [&from](const PointVisitor& visit) { visit_scan(from.scan, visit); };
  Surface seen = surface_of(source, map, options);
  seen.sensors = {from.place};
  View view;
  view.dropped = drop_mixed_returns(seen);
  view.seen = (!seen.height.z.isNaN()).cast<int>();
  const SightLines sight(seen.height, from.place);
  view.ceiling = map.z;
  for_each_cell(map.z, [&](Cell at) { view.ceiling(at.row, at.col) = sight.ceiling(at); });
  return view;
}

/// True if a point of a view counts: not mixed, and not in space that is empty by another view.
bool counts(const std::vector<View>& views, std::size_t own, const HeightMap& map,
            const Eigen::Vector3d& point) {
  constexpr double place = 0.5;  // ours: of a cell, by which clouds may lie apart
  const Eigen::Vector2d at = (point.head<2>() - map.origin) / map.cell_size;
  const Rectangle all = {0.0, 0.0, static_cast<double>(map.z.cols()) - 0.5,
                         static_cast<double>(map.z.rows()) - 0.5};
  if (!all.contains(std::floor(at.x()), std::floor(at.y()))) return true;
  const auto row = static_cast<Index>(at.y());
  const auto col = static_cast<Index>(at.x());
  if (views[own].dropped(row, col) != 0) return false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i != own && point.z() > views[i].ceiling(row, col) + place * map.cell_size) return false;
  }
  return true;
}

/// From several standpoints.
Surface surface_of(const std::vector<Standpoint>& standpoints, const HeightMap& map,
                   const RasterOptions& options) {
  std::vector<View> views;
  views.reserve(standpoints.size());
  for (const Standpoint& from : standpoints) views.push_back(view_from(from, map, options));
  const PointSource kept = [&](const PointVisitor& visit) {
    std::vector<Eigen::Vector3d> some;
    for (std::size_t i = 0; i < standpoints.size(); ++i) {
      visit_scan(standpoints[i].scan, [&](const std::vector<Eigen::Vector3d>& points) {
        some.clear();
        std::copy_if(points.begin(), points.end(), std::back_inserter(some),
                     [&](const Eigen::Vector3d& p) { return counts(views, i, map, p); });
        visit(some);
      });
    }
  };
  Surface surface = surface_of(kept, map, options);
  surface.seen_from = Eigen::ArrayXXi::Zero(map.z.rows(), map.z.cols());
  for (std::size_t i = 0; i < views.size(); ++i) {
    surface.sensors.push_back(standpoints[i].place);
    surface.seen_from += (1 << i) * views[i].seen;
  }
  return surface;
}

}  // namespace

Surface survey_surface(const Scan& scan, const Rectangle& extent, const RasterOptions& options) {
  const std::vector<Standpoint> standpoints = standpoints_of(scan);
  const HeightMap map = empty_map(extent, options);
  if (standpoints.size() > 1) return surface_of(standpoints, map, options);
  const PointSource source = [&scan](const PointVisitor& visit) { visit_scan(scan, visit); };
  Surface surface = surface_of(source, map, options);
  if (!standpoints.empty()) surface.sensors = {standpoints.front().place};
  return surface;
}

std::vector<Surface> survey_surfaces(const std::vector<Scan>& scans, const Rectangle& extent,
                                     const RasterOptions& options, unsigned threads) {
  std::vector<Surface> surfaces(scans.size());
  parallel_for(scans.size(), threads,
               [&](std::size_t i) { surfaces[i] = survey_surface(scans[i], extent, options); });
  return surfaces;
}

}  // namespace excavplan
