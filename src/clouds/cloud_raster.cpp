// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_raster.hpp"

#include <cmath>
#include <string>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "base/text.hpp"
#include "clouds/cloud_cell.hpp"
#include "clouds/cloud_summary.hpp"
#include "clouds/ground_bands.hpp"
#include "clouds/points_by_cell.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double most_raster_cells = 1e8;

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

}  // namespace

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
  if (!(columns.count * rows.count <= most_raster_cells)) {
    refuse("cells of " + number_text(options.cell_size) + " m make a map of " +
           number_text(columns.count) + " x " + number_text(rows.count) +
           ", at most 100 million cells are possible");
  }
  HeightMap map;
  map.cell_size = options.cell_size;
  map.origin = node + options.cell_size * Eigen::Vector2d(columns.first, rows.first);
  map.z = Eigen::ArrayXXd::Constant(static_cast<Index>(rows.count),
                                    static_cast<Index>(columns.count), nan);
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

HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options) {
  return surface_of(points_of(cloud), empty_map(extent, options), options).height;
}

}  // namespace excavplan
