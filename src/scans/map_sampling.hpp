// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>

/// @file
/// Layers of one map on the cells of another. Private to the project.

namespace excavplan {

/// A layer of `grid` on the cells of `other`: the mean of its known cells where the centres of
/// several lie in a cell, else the value at its centre. NaN where nothing is known.
Eigen::ArrayXXd layer_on(const HeightMap& other, const HeightMap& grid,
                         const Eigen::ArrayXXd& layer);

/// The value of the cell that a place lies in; NaN off the map.
double cell_value(const HeightMap& grid, const Eigen::ArrayXXd& layer, const Eigen::Vector2d& at);

}  // namespace excavplan
