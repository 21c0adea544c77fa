// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// Slopes of a map, surfaces of bounded slope, and the distances that follow from them. Private to
/// the project.

namespace excavplan {

/// Gradient of a map by planes through 3 x 3 cells; NaN where a cell of them is unknown.
struct Gradient {
  Eigen::ArrayXXd x;
  Eigen::ArrayXXd y;
};
Gradient gradient_of(const HeightMap& map);

/// The highest surface below `z` whose slope is nowhere above `rise` per cell. Unknown cells are no
/// bound.
Eigen::ArrayXXd slope_limited(const Eigen::ArrayXXd& z, double rise);

/// From every cell to the nearest one that is marked, within 8 % (chamfer); infinite without one
/// [cell].
Eigen::ArrayXXd distance_to(const Mask& marked);

}  // namespace excavplan
