// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <excavplan/machine/way.hpp>

namespace excavplan {

/// A short part of the smooth path q(s) of the joints, whose direction changes linearly; s is about
/// the length in joint space.
struct PathCell {
  double length = 0.0;                      ///< in s [rad]
  FrontJoints begin = FrontJoints::Zero();  ///< q [rad]
  FrontJoints slope = FrontJoints::Zero();  ///< dq/ds at its begin
  FrontJoints bend = FrontJoints::Zero();   ///< d²q/ds² [1/rad]
  DigPhase phase = DigPhase::approach;
  JointAngles torque = JointAngles::Zero();  ///< [N m]
  double payload = 0.0;                      ///< [kg]

  /// dq/ds at its end.
  FrontJoints last_slope() const { return slope + length * bend; }
  /// q at s from its begin.
  FrontJoints at(double s) const { return begin + s * (slope + 0.5 * s * bend); }
};

/// The path along a way, with a parabola at each of its corners.
struct SmoothPath {
  std::vector<PathCell> cells;
  std::vector<std::size_t> stops;  ///< first cells after a rest, and the number of cells
};

/// @param tolerance  as MotionOptions::corner_tolerance [m]
SmoothPath smooth_path(const Machine& machine, const Way& way, double tolerance);

}  // namespace excavplan
