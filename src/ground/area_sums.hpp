// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ground/grid_cells.hpp"

/// @file
/// Sums over rectangles of cells. Private to the project.

namespace excavplan {

/// A summed-area table (Crow 1984).
class AreaSums {
 public:
  explicit AreaSums(const Eigen::ArrayXXd& field);

  /// Over the square around a cell, as far as the field reaches.
  double around(Cell at, Eigen::Index radius) const;

 private:
  Eigen::ArrayXXd sums_;  // up to each cell, with a margin of zeros
};

}  // namespace excavplan
