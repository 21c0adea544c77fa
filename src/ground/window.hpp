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

/// Cells whose middle is at least `margin` from all that is not in an area. Across each cell its
/// edge is taken to run square to the way there, which errs by a fifth of a cell at most.
/// @param share  of each cell that is in the area [-]; beyond the grid nothing is
Mask inner_cells(const Eigen::ArrayXXd& share, double cell_size, double margin);

// Larger cells: squares of `by` cells, without what is left over at the upper edges.

/// Means of the known cells of each square.
inline HeightMap coarser(const HeightMap& map, Eigen::Index by) {
  if (by == 1) return map;
  HeightMap coarse = map;
  coarse.cell_size = map.cell_size * static_cast<double>(by);
  coarse.z.resize(map.z.rows() / by, map.z.cols() / by);
  for (Eigen::Index row = 0; row < coarse.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < coarse.z.cols(); ++col) {
      const auto cells = map.z.block(row * by, col * by, by, by);
      const auto known = cells.isFinite();
      coarse.z(row, col) = known.select(cells, 0.0).sum() / static_cast<double>(known.count());
    }
  }
  return coarse;
}

/// The cells in the middle of the squares.
template <typename Layer>
typename Layer::PlainObject middle_cells(const Layer& layer, Eigen::Index by) {
  typename Layer::PlainObject coarse(layer.rows() / by, layer.cols() / by);
  for (Eigen::Index row = 0; row < coarse.rows(); ++row) {
    for (Eigen::Index col = 0; col < coarse.cols(); ++col) {
      coarse(row, col) = layer(row * by + by / 2, col * by + by / 2);
    }
  }
  return coarse;
}

}  // namespace excavplan
