// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ground/grid_cells.hpp"

/// @file
/// Of the cells in a window around each cell. Private to the project.

namespace excavplan {

/// The highest of each cell and those up to so many cells away along both axes; NaN is not allowed.
Eigen::ArrayXXd highest_within(const Eigen::ArrayXXd& z, Eigen::Index cells);

/// Likewise the lowest.
inline Eigen::ArrayXXd lowest_within(const Eigen::ArrayXXd& z, Eigen::Index cells) {
  return -highest_within(-z, cells);
}

/// `value` in place of NaN.
inline Eigen::ArrayXXd without_nan(const Eigen::ArrayXXd& z, double value) {
  return z.isNaN().select(value, z);
}

/// Sums over windows: a summed-area table (Crow 1984).
class AreaSums {
 public:
  explicit AreaSums(const Eigen::ArrayXXd& field);

  /// Over the square around a cell, as far as the field reaches.
  double around(Cell at, Eigen::Index radius) const;

 private:
  Eigen::ArrayXXd sums_;  // up to each cell, with a margin of zeros
};

}  // namespace excavplan
