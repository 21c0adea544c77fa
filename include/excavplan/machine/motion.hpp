// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <excavplan/machine/trajectory.hpp>
#include <excavplan/machine/way.hpp>

/// @file
/// Motion that a controller can run: a trajectory at a fixed rate that keeps the limits between its
/// points too (docs/methods.md#motion).
///
/// The joints are uniform cubic B-splines of time with their knots at the points. Between two
/// points they are cubic, so that the cubic through the stated angles and rates and the quintic
/// through the stated angles, rates and accelerations are both this motion itself.

namespace excavplan {

/// The way of a dig: approach, penetrate, drag, scoop and lift.
/// @param torques  as for time_dig_path()
/// @throws Error (bad_input) as time_dig_path()
Way way_of(const DigPath& path, const std::vector<JointAngles>& torques = {});

/// Settings of time_way().
struct MotionOptions {
  double rate = 100.0;  ///< points per second, in 10 .. 500; below 50 the machine is slower
  /// As TrajectoryOptions::speed_fraction, of the swing too.
  double speed_fraction = TrajectoryOptions{}.speed_fraction;
  /// As TrajectoryOptions::corner_tolerance, at every corner of the way.
  double corner_tolerance = TrajectoryOptions{}.corner_tolerance;
  double max_jerk = std::numeric_limits<double>::infinity();  ///< of each joint [rad/s^3], >= 0.1
};

/// @throws Error (bad_input) if an option is out of range, as time_way()
void check(const MotionOptions& options);

/// Times a way as fast as the limits allow, from rest to rest. At every time, between the points
/// too, the joints are within the range of the way's poses, and their rates and accelerations
/// within the limits times the speed fraction, but for rounding; so are cylinder speeds, pump flow,
/// the torque of the swing and the power of cylinders and swing together, checked every
/// millisecond.
///
/// Corners are rounded by the corner tolerance; the machine stops where the way turns by more than
/// 120 degrees. Besides, the tip leaves the way by some 2 mm for each joint at most.
///
/// @throws Error (bad_input) as require_machine(); if an option is out of range, the way has fewer
///         than two poses that differ, a number that is not finite, a joint beyond its limits (by
///         more than 1e-9 rad), a payload below 0, phases out of order, or swings without a swing
///         in the machine
Trajectory time_way(const Machine& machine, const Way& way, const MotionOptions& options = {});

}  // namespace excavplan
