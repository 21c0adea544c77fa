// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/dig_path.hpp>

/// @file
/// Where the joints go, swing included, without the times.

namespace excavplan {

/// (boom, arm, bucket, swing) [rad]; the swing as SwingState::angle, within 10^4 rad.
using FrontJoints = Eigen::Vector4d;

/// The joints at one place of a way.
struct WayPose {
  DigPhase phase = DigPhase::approach;       ///< that leads here
  FrontJoints joints = FrontJoints::Zero();  ///< [rad]
  JointAngles torque = JointAngles::Zero();  ///< of boom, arm, bucket on the way here [N m]
  double payload = 0.0;                      ///< in the bucket on the way here [kg], >= 0
};

/// Where the joints go, in straight lines of the joint space from pose to pose.
struct Way {
  std::vector<WayPose> poses;          ///< in the order in which they are visited
  std::vector<Warning> warnings = {};  ///< of way_of_cycle()
};

}  // namespace excavplan
