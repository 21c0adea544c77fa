// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <excavplan/plan/plan_dig.hpp>

namespace excavplan {

/// What a robot calls its joints: swing, boom, arm, bucket. An empty name leaves the joint out of
/// what is sent. The default is that of OPERA.
using JointNames = std::array<std::string, 4>;
/// "swing_joint", "boom_joint", "arm_joint", "bucket_joint".
JointNames opera_joint_names();

/// All joints at one time, in the order of JointMotion::names.
struct JointPoint {
  double time = 0.0;               ///< from the start [s]
  std::vector<double> positions;   ///< [rad]
  std::vector<double> velocities;  ///< [rad/s]
};

/// What a joint trajectory controller takes.
struct JointMotion {
  std::vector<std::string> names;  ///< of the joints
  std::vector<JointPoint> points;  ///< times strictly increasing; empty: no dig
};

/// The motion of a plan as its trajectory is; the swing stands at 0.
JointMotion joint_motion(const DigPlan& plan, const JointNames& names);

}  // namespace excavplan
