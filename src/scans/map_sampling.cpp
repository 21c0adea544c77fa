// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/map_sampling.hpp"

#include <algorithm>
#include <cmath>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

/// First cell whose centre is at or above a coordinate counted in cells from the corner.
Index first_centre(double from, Index cells) {
  constexpr double rounding = 1e-6;
  const double first = std::ceil(from - 0.5 - rounding);
  return static_cast<Index>(std::clamp(first, 0.0, static_cast<double>(cells)));
}

/// The value of a cell is that of its centre: elsewhere it would be moved by up to half a cell.
bool lies_off_centre(const HeightMap& grid, const Eigen::Vector2d& at) {
  constexpr double rounding = 1e-6;
  const Eigen::Array2d cells = (at - grid.origin) / grid.cell_size;
  return ((cells - cells.floor() - 0.5).abs() > rounding).any();
}

}  // namespace

double cell_value(const HeightMap& grid, const Eigen::ArrayXXd& layer, const Eigen::Vector2d& at) {
  const Eigen::Vector2d place = (at - grid.origin) / grid.cell_size;
  const bool is_on = place.x() >= 0.0 && place.y() >= 0.0 &&
                     place.x() < static_cast<double>(layer.cols()) &&
                     place.y() < static_cast<double>(layer.rows());
  return is_on ? layer(static_cast<Index>(place.y()), static_cast<Index>(place.x())) : std::nan("");
}

Eigen::ArrayXXd layer_on(const HeightMap& other, const HeightMap& grid,
                         const Eigen::ArrayXXd& layer) {
  const HeightMap map{grid.origin, grid.cell_size, layer};
  Eigen::ArrayXXd result(other.z.rows(), other.z.cols());
  for_each_cell(result, [&](Cell at) {
    const Eigen::Vector2d centre(other.x(at.col), other.y(at.row));
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * other.cell_size);
    const Eigen::Vector2d from = (centre - half - grid.origin) / grid.cell_size;
    const Eigen::Vector2d to = (centre + half - grid.origin) / grid.cell_size;
    double sum = 0.0;
    Index known = 0;
    Index inside = 0;
    for (Index row = first_centre(from.y(), layer.rows()); row < first_centre(to.y(), layer.rows());
         ++row) {
      for (Index col = first_centre(from.x(), layer.cols());
           col < first_centre(to.x(), layer.cols()); ++col) {
        ++inside;
        if (std::isnan(layer(row, col))) continue;
        sum += layer(row, col);
        ++known;
      }
    }
    double value = known > 0 ? sum / static_cast<double>(known) : std::nan("");
    if (inside == 0 || (inside == 1 && lies_off_centre(grid, centre))) {
      value = height_at(map, centre.x(), centre.y());
      if (std::isnan(value)) value = cell_value(grid, layer, centre);
    }
    result(at.row, at.col) = value;
  });
  return result;
}

}  // namespace excavplan
