// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace excavplan {

/// An axis-parallel rectangle in the site plane [m].
struct Rectangle {
  double x_min = 0.0;  ///< [m]
  double y_min = 0.0;  ///< [m]
  double x_max = 0.0;  ///< [m]
  double y_max = 0.0;  ///< [m]

  /// True for points inside and on the lower edges.
  bool contains(double x, double y) const {
    return x >= x_min && x < x_max && y >= y_min && y < y_max;
  }
};

/// Heights of the ground on a regular grid, seen from above, in the site frame.
///
/// Cell (row, col) is the square whose corner of smallest x and y is at origin + cell_size * (col,
/// row); its height is the mean height of the ground inside it. A cell that no scan has seen is
/// NaN; it stays NaN in every function that does not say that it fills.
struct HeightMap {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< corner of cell (0, 0): x, y [m]
  double cell_size = 0.05;                           ///< edge of a cell [m], > 0
  Eigen::ArrayXXd z;                                 ///< (rows along y, cols along x) [m]

  /// x of the centres of a column [m].
  double x(Eigen::Index col) const {
    return origin.x() + cell_size * (static_cast<double>(col) + 0.5);
  }
  /// y of the centres of a row [m].
  double y(Eigen::Index row) const {
    return origin.y() + cell_size * (static_cast<double>(row) + 0.5);
  }
  /// All that the cells cover.
  Rectangle extent() const {
    return {origin.x(), origin.y(), origin.x() + cell_size * static_cast<double>(z.cols()),
            origin.y() + cell_size * static_cast<double>(z.rows())};
  }
};

/// Level ground that covers at least `extent`.
///
/// @throws Error (bad_input) if the extent is empty, the cell is not positive, or the map would
///         have more than 100 million cells
HeightMap flat_ground(const Rectangle& extent, double cell_size, double height = 0.0);

/// Height at a point, bilinear between the centres of the four cells around it; within half a cell
/// of the border that of the nearest centres. NaN outside the map or beside an unknown cell.
double height_at(const HeightMap& map, double x, double y);

/// True if both maps have the same origin, cell and size, to 1e-9 of a cell.
bool same_grid(const HeightMap& a, const HeightMap& b);

}  // namespace excavplan
