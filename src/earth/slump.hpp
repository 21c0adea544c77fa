// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "earth/ground_window.hpp"

namespace excavplan {

/// Steepest slopes of the two layers.
struct SlopeLimits {
  double loose_slope = 0.0;  ///< tangent of the angle of repose
  bool bank_stands = false;  ///< walls of undisturbed soil are held, however high
  /// Slopes steeper by less than this share are at rest; what is steeper slides until it is less
  /// steep by this share [-]; ours: half a degree.
  double slack = 0.02;
};

/// Lets soil slide where it stands too steep, inside `block` and one cell around it, which grows as
/// soil leaves it. Undisturbed soil breaks off walls above its critical height down to its friction
/// angle. At most `sweeps` passes, each after one on cells of twice the size where these are small
/// and soil slides: the same soil gets as far on small cells as on large ones. Returns the block
/// that may still move, empty once all is at rest. Solids are conserved to rounding; unknown
/// cells are walls.
CellBlock slump(GroundWindow& ground, CellBlock block, const SlopeLimits& limits, int sweeps);

/// Heaps `volume` of loose soil on the terrain as a cone of the given slope with its axis at (x,
/// y).
/// @throws Error (bad_input) if the axis is off the map or on unknown ground
void pour(GroundWindow& ground, const Eigen::Vector2d& at, double volume, double slope);

}  // namespace excavplan
