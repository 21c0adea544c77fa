// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

/// @file
/// Which relief of two surfaces tells that one was shifted. Private to the project.

namespace excavplan {

/// A cell with a slope, and by how much it rose beyond the motion of level ground.
struct ReliefCell {
  Cell cell;
  Eigen::Vector2d slope;  ///< [-]
  double rise;            ///< [m]
};

/// Marks the cells of relief that agrees on a shift; none if no shift can be told.
///
/// A shift moves all relief: what one side of a heap gains, the other loses. Growth moves one
/// piece, and seems a shift to each of its sides. So a piece is a witness where opposite sides tell
/// its shift from its growth, and a shift is told by two witnesses or more whose sides all show it
/// and that hold more than half of the cells of all (docs/methods.md#known-ground).
///
/// @param cell_noise  standard deviation of a rise [m]
Mask relief_that_agrees(const std::vector<ReliefCell>& cells, const HeightMap& grid,
                        double cell_noise);

}  // namespace excavplan
