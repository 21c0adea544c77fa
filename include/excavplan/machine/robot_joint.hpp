// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace excavplan {

/// What a robot calls a joint, and how it counts its angle: ours = sign * its + zero.
struct RobotJoint {
  std::string name;   ///< empty: the robot has no such joint
  double sign = 1.0;  ///< -1 or 1
  double zero = 0.0;  ///< [rad]

  double to_ours(double its) const { return sign * its + zero; }        ///< angles [rad]
  double from_ours(double ours) const { return sign * (ours - zero); }  ///< angles [rad]
};

/// Of boom, arm, bucket and swing.
using RobotJoints = std::array<RobotJoint, 4>;

}  // namespace excavplan
