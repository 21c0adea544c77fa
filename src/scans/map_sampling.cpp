// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/map_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

constexpr double rounding = 1e-6;  // of a cell

/// First cell whose centre is at or above a coordinate counted in cells from the corner.
Index first_centre(double from, Index cells) {
  const double first = std::ceil(from - 0.5 - rounding);
  return static_cast<Index>(std::clamp(first, 0.0, static_cast<double>(cells)));
}

/// The cells along one axis whose centres lie in a cell of another grid.
struct Span {
  Index first, end;
  bool is_off_centre;  ///< of its own cell: there a value would be moved by up to half a cell
};

/// One for each column of `other`, or for each row.
std::vector<Span> spans_on(const HeightMap& grid, const HeightMap& other, bool of_columns) {
  const int axis = of_columns ? 0 : 1;
  const Index count = of_columns ? other.z.cols() : other.z.rows();
  const Index cells = of_columns ? grid.z.cols() : grid.z.rows();
  const double half = 0.5 * other.cell_size;
  std::vector<Span> spans(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    const double centre = of_columns ? other.x(i) : other.y(i);
    const auto place = [&](double at) { return (at - grid.origin(axis)) / grid.cell_size; };
    const double own = place(centre);
    spans[static_cast<std::size_t>(i)] = {first_centre(place(centre - half), cells),
                                          first_centre(place(centre + half), cells),
                                          std::abs(own - std::floor(own) - 0.5) > rounding};
  }
  return spans;
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
  const std::vector<Span> columns = spans_on(map, other, true);
  const std::vector<Span> rows = spans_on(map, other, false);
  Eigen::ArrayXXd result(other.z.rows(), other.z.cols());
  for_each_cell(result, [&](Cell at) {
    const Span& along_x = columns[static_cast<std::size_t>(at.col)];
    const Span& along_y = rows[static_cast<std::size_t>(at.row)];
    double sum = 0.0;
    Index known = 0;
    for (Index row = along_y.first; row < along_y.end; ++row) {
      for (Index col = along_x.first; col < along_x.end; ++col) {
        if (std::isnan(layer(row, col))) continue;
        sum += layer(row, col);
        ++known;
      }
    }
    const Index inside = (along_y.end - along_y.first) * (along_x.end - along_x.first);
    double value = known > 0 ? sum / static_cast<double>(known) : std::nan("");
    if (inside == 0 || (inside == 1 && (along_x.is_off_centre || along_y.is_off_centre))) {
      const Eigen::Vector2d centre(other.x(at.col), other.y(at.row));
      value = height_at(map, centre.x(), centre.y());
      if (std::isnan(value)) value = cell_value(grid, layer, centre);
    }
    result(at.row, at.col) = value;
  });
  return result;
}

}  // namespace excavplan
