// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/height_map.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double grid_tolerance = 1e-9;  // of a cell

/// The two cell centres around a place on one axis and the weight of the second.
struct Bracket {
  Eigen::Index first;
  Eigen::Index second;
  double weight;
};

Bracket bracket(double cells_from_first_centre, Eigen::Index count) {
  const auto last = static_cast<double>(count - 1);
  const double place = std::clamp(cells_from_first_centre, 0.0, last);
  const auto first = static_cast<Eigen::Index>(place);
  return {first, std::min(first + 1, count - 1), place - static_cast<double>(first)};
}

}  // namespace

HeightMap flat_ground(const Rectangle& extent, double cell_size, double height) {
  const double width = extent.x_max - extent.x_min;
  const double depth = extent.y_max - extent.y_min;
  if (!(width > 0.0 && depth > 0.0 && std::isfinite(width) && std::isfinite(depth))) {
    throw Error(ErrorKind::bad_input, "extent of the map is " + number_text(width) + " m x " +
                                          number_text(depth) + " m, must be positive and finite");
  }
  if (!(cell_size > 0.0 && std::isfinite(cell_size))) {
    throw Error(ErrorKind::bad_input, "cell is " + number_text(cell_size) + " m, must be positive");
  }
  if (std::isinf(height)) {
    throw Error(ErrorKind::bad_input, "height of the map is infinite, must be finite or NaN");
  }
  const double cols = std::max(1.0, std::ceil(width / cell_size - grid_tolerance));
  const double rows = std::max(1.0, std::ceil(depth / cell_size - grid_tolerance));
  if (!(rows * cols <= most_cells)) {
    throw Error(ErrorKind::bad_input,
                "a map of " + number_text(width) + " m x " + number_text(depth) +
                    " m in cells of " + number_text(cell_size) + " m holds " +
                    number_text(rows * cols) + " cells, most are " + number_text(most_cells));
  }
  HeightMap map;
  map.origin = {extent.x_min, extent.y_min};
  map.cell_size = cell_size;
  map.z = Eigen::ArrayXXd::Constant(static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(cols), height);
  return map;
}

double height_at(const HeightMap& map, double x, double y) {
  const double u = (x - map.origin.x()) / map.cell_size;
  const double v = (y - map.origin.y()) / map.cell_size;
  const bool inside = u >= 0.0 && v >= 0.0 && u <= static_cast<double>(map.z.cols()) &&
                      v <= static_cast<double>(map.z.rows());
  if (!inside || map.z.size() == 0) return nan;
  const Bracket col = bracket(u - 0.5, map.z.cols());
  const Bracket row = bracket(v - 0.5, map.z.rows());
  // A centre of zero weight must not contribute its NaN.
  const auto mix = [](double first, double second, double weight) {
    return weight == 0.0 ? first : (1.0 - weight) * first + weight * second;
  };
  const auto along_x = [&](Eigen::Index r) {
    return mix(map.z(r, col.first), map.z(r, col.second), col.weight);
  };
  return mix(along_x(row.first), along_x(row.second), row.weight);
}

bool same_grid(const HeightMap& a, const HeightMap& b) {
  const double tolerance = grid_tolerance * a.cell_size;
  return a.z.rows() == b.z.rows() && a.z.cols() == b.z.cols() &&
         std::abs(a.cell_size - b.cell_size) <= tolerance &&
         ((a.origin - b.origin).array().abs() <= tolerance).all();
}

}  // namespace excavplan
