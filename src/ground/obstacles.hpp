// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>

/// @file
/// What stands on the ground, told from it by its shape.

namespace excavplan {

/// Height above the ground around it from which something is an obstacle [m]; ours, as of what
/// estimate_density() takes out of scans.
constexpr double least_obstacle = 0.5;

using CellMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Cells of what stands more than least_obstacle above the ground around it, with faces steeper
/// than 60 degrees: posts, walls, boxes, vehicles, however wide, up to 20 m² (ours). Not the rim of
/// a pit or a bench, which ground of its own height adjoins, and nothing that goes on over the edge
/// of the map without a face.
/// @param highest  of each cell; NaN: unknown
CellMask find_obstacles(const HeightMap& highest);

/// The terrain with what find_obstacles() finds on its surface, unless it has obstacles already.
Terrain with_obstacles(const Terrain& terrain);

}  // namespace excavplan
