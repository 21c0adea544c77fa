// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// The ground that a machine digs: its extent, its profile under the bucket, the part that a path
/// sweeps, and ideal ground for planning and calibration.

namespace excavplan {

/// Ground that affects a dig: from near the tracks to the machine's reach, wide enough for the
/// bucket and its windrows.
Rectangle planning_extent(const Machine& machine);

/// Smallest cell size at which tools and libraries simulate [m]; ours: a dig on smaller cells takes
/// minutes.
inline constexpr double finest_cell = 0.005;
/// Largest cell size likewise [m].
inline constexpr double coarsest_cell = 1.0;

/// @throws Error (bad_input) unless a cell size is in finest_cell .. coarsest_cell
void require_simulated_cell(double cell_size);

/// How many times longer the digs of a machine are than those of the zx120, as the ranges of a
/// search are: the ratio of the lengths of the buckets.
double dig_size(const Machine& machine);

/// Cell size of the ground that a machine digs: 5 cm for the zx120, else times dig_size() to a
/// millimetre, within finest_cell .. coarsest_cell; ours [m].
double usual_cell(const Machine& machine);

/// planning_extent() as level ground. @throws Error (bad_input) as require_simulated_cell()
Terrain level_planning_ground(const Machine& machine, double cell_size);
Terrain level_planning_ground(const Machine& machine);  ///< in cells of usual_cell()

/// Ground that the front can pass over: the square around the circle of its reach, swung all round.
Rectangle swing_extent(const Machine& machine);
/// What decides whether the machine can stand: its tracks and 6 m (ours) about them [m].
/// @throws Error (bad_input) as require_machine()
Rectangle standing_extent(const Machine& machine);

/// swing_extent() as level ground, in cells of usual_cell().
Terrain level_swing_ground(const Machine& machine);

/// Height of a surface in the boom plane. The profile keeps a copy of the rows of cells that it
/// needs.
GroundProfile boom_plane_profile(const HeightMap& surface);
GroundProfile boom_plane_profile(const Terrain& terrain);  ///< of its surface
/// Where the edge of a bucket in the boom plane enters the ground, for make_dig_path(): the median
/// of the heights under its width, of which the noise of a scan moves one row of cells by several
/// centimetres and all of them by few millimetres. NaN where less than half of the width is known.
GroundProfile start_profile(const HeightMap& surface, const Machine& machine);
GroundProfile start_profile(const Terrain& terrain, const Machine& machine);  ///< of its surface

/// Mean height of a surface over the width of the bucket and 0.15 m to both sides of x (ours): for
/// scans, where the noise of one cell would move a path. Keeps a reference to the surface.
GroundProfile profile_under_bucket(const HeightMap& surface, const Machine& machine);

/// The ground over which the tip passes while it digs, as wide as the bucket.
Rectangle swept_strip(const Machine& machine, const DigPath& path);

/// Height of the line that the tip follows while it digs, the lower one where it passes twice [m];
/// NaN where it does not dig.
double swept_height(const DigPath& path, double x);

/// Slope of the surface in the boom plane from `from_x` to `to_x` [rad], positive if it rises away
/// from the machine: least-squares line through the known cells. NaN with fewer than two.
double boom_plane_slope(const Terrain& terrain, double from_x,
                        double to_x = std::numeric_limits<double>::infinity());

/// planning_extent() as ground that is level up to the front of the tracks and rises by `slope`
/// [rad] beyond it. @throws Error (bad_input) as require_simulated_cell()
Terrain sloped_planning_ground(const Machine& machine, double slope, double cell_size);

/// Default place for the dug soil, (x, y) [m]; ours: beside the dig, clear of its windrows and
/// within the reach of the machine where it stands.
Eigen::Vector2d default_dump_point();

/// Ground for the digs of a machine and a heap at `dump_at`.
Rectangle scene_extent(const Machine& machine, const Eigen::Vector2d& dump_at);

}  // namespace excavplan
