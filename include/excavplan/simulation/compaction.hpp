// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// Loose soil under the tracks of a machine that stood on it.

namespace excavplan {

/// A rectangle that presses on the ground, such as one track.
struct Load {
  Rectangle area;         ///< in its own frame [m]
  double pressure = 0.0;  ///< mean, under it [Pa]
  /// Of that frame on the terrain.
  Eigen::Isometry2d place = Eigen::Isometry2d::Identity();
};

/// Compacts the loose soil of the cells whose middle lies under a load, as compacted_void_ratio()
/// says for the stress at half the depth of the layer: that of the load, spread 2 : 1, and of the
/// soil's own weight. The layer becomes thinner and denser; its solids and the bank stay.
///
/// @throws Error (bad_input) as require_soil(), or if the terrain's layers differ in size, a void
///         ratio under the load is not one of loose soil, the area is empty or a number not finite
void compact(Terrain& terrain, const SoilKind& soil, const Load& load);

}  // namespace excavplan
