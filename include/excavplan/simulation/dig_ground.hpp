// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// The ground that a machine digs: its extent, its profile in the boom plane, and ideal grounds to
/// plan and calibrate on.

namespace excavplan {

/// Ground that matters for a dig: from near the tracks to the machine's reach, one bucket and its
/// windrows wide on both sides of the boom plane.
Rectangle planning_extent(const Machine& machine);

/// Between which cells the tools and libraries simulate the ground [m]; ours: a dig on finer ones
/// takes minutes.
inline constexpr double finest_cell = 0.005;
inline constexpr double coarsest_cell = 1.0;

/// planning_extent() as level ground.
Terrain level_planning_ground(const Machine& machine, double cell_size = 0.05);

/// Height of a surface in the boom plane, for make_dig_path(). The profile keeps a copy of the row
/// of cells it needs.
GroundProfile boom_plane_profile(const HeightMap& surface);
GroundProfile boom_plane_profile(const Terrain& terrain);  ///< of its surface

/// Mean height of a surface over the width of the bucket and 0.15 m to both sides of x (ours): for
/// scans, where the noise of one cell would move a path. Keeps a reference to the surface.
GroundProfile profile_under_bucket(const HeightMap& surface, const Machine& machine);

/// The ground over which the tip passes while it digs, as wide as the bucket.
Rectangle swept_strip(const Machine& machine, const DigPath& path);

/// Height of the line that the tip follows while it digs, the lower one where it passes twice [m];
/// NaN where it does not dig.
double swept_height(const DigPath& path, double x);

/// Slope of the surface in the boom plane from `from_x` on, rising away from the machine [rad]: the
/// line of least squares through the known cells. NaN with fewer than two.
double boom_plane_slope(const Terrain& terrain, double from_x);

/// Level ground under the machine that rises by `slope` [rad] from the front of its tracks on.
Terrain sloped_planning_ground(const Machine& machine, double slope, double cell_size);

/// Where dug soil goes unless said otherwise: beside the dig, clear of its windrows, within the
/// swing of a machine that does not move (x, y) [m]; ours.
Eigen::Vector2d default_dump_point();

/// Ground that holds the digs of a machine and a heap at `dump_at`.
Rectangle scene_extent(const Machine& machine, const Eigen::Vector2d& dump_at);

}  // namespace excavplan
