// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "base/text.hpp"
#include "ground/sight_lines.hpp"
#include "scans/cloud_cell.hpp"
#include "scans/ground_bands.hpp"
#include "scans/points_by_cell.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double most_cells = 1e8;

/// Lattice lines of the grid before `low` and behind `high`, with room for rounding.
struct Span {
  double first = 0.0;
  double count = 0.0;
};
Span span_of(double low, double high, double cell) {
  constexpr double rounding = 1e-9;
  const double first = std::floor(low / cell + rounding);
  return {first, std::ceil(high / cell - rounding) - first};
}

HeightMap empty_map(const Rectangle& extent, const RasterOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorKind::bad_input, "rasterise: " + what);
  };
  if (!(options.cell_size > 0.0) || !std::isfinite(options.cell_size)) {
    refuse("cell is " + number_text(options.cell_size) + " m, must be > 0");
  }
  if (!(options.outlier_distance > 0.0)) {
    refuse("outlier_distance is " + number_text(options.outlier_distance) + ", must be > 0");
  }
  const Eigen::Vector2d& node = options.node;
  if (!node.allFinite()) refuse("node is not finite");
  const Span columns = span_of(extent.x_min - node.x(), extent.x_max - node.x(), options.cell_size);
  const Span rows = span_of(extent.y_min - node.y(), extent.y_max - node.y(), options.cell_size);
  if (!(columns.count > 0.0) || !(rows.count > 0.0)) {
    refuse("extent x " + number_text(extent.x_min) + " .. " + number_text(extent.x_max) + ", y " +
           number_text(extent.y_min) + " .. " + number_text(extent.y_max) + " m is empty");
  }
  if (!(columns.count * rows.count <= most_cells)) {
    refuse("cells of " + number_text(options.cell_size) + " m make a map of " +
           number_text(columns.count) + " x " + number_text(rows.count) +
           ", at most 100 million cells are possible");
  }
  HeightMap map;
  map.cell_size = options.cell_size;
  map.origin = node + options.cell_size * Eigen::Vector2d(columns.first, rows.first);
  map.z = Eigen::ArrayXXd::Constant(static_cast<Index>(rows.count),
                                    static_cast<Index>(columns.count), unknown);
  return map;
}

Surface surface_of(const PointSource& source, const HeightMap& map, const RasterOptions& options) {
  PointsByCell points(source, map, options.memory);
  const GroundBands ground(points, map.cell_size, options.outlier_distance);
  OutlierTally outliers(ground.gap());
  Surface surface{map, map.z, Eigen::ArrayXXi::Zero(map.z.rows(), map.z.cols())};
  surface.doubt = Eigen::ArrayXXf::Zero(map.z.rows(), map.z.cols());
  surface.below = surface.doubt;
  Eigen::ArrayXXf reach = surface.doubt;
  points.for_each_cell([&](Index cell, CellRange in_cell) {
    const double level = ground.level(cell);
    const Band band = ground.band(cell);
    const CellHeight result = mean_height(in_cell, band, level, ground.noise());
    surface.height.z(cell) = points.base() + (level + result.height);
    surface.below(cell) = static_cast<float>(result.height - result.lowest);
    surface.variance(cell) = result.variance;
    surface.doubt(cell) = static_cast<float>(ground.doubt(cell));
    surface.points(cell) = static_cast<int>(std::lround(result.points * points.per_kept(cell)));
    reach(cell) = static_cast<float>(band.farthest());
    outliers.add(in_cell, band);
  });
  surface.outlier_bias = reach.unaryExpr([bias = outliers.bias()](float r) {
    return static_cast<float>(bias.within(static_cast<double>(r)));
  });
  return surface;
}

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

HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options) {
  const PointSource source = [&cloud](const PointVisitor& visit) { visit(cloud.points); };
  return surface_of(source, empty_map(extent, options), options).height;
}

}  // namespace excavplan
