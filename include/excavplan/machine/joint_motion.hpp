// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <excavplan/machine/trajectory.hpp>

namespace excavplan {

/// All joints at one time, in the order of JointMotion::names.
struct JointPoint {
  std::int64_t time_ns = 0;           ///< from the start, rounded [ns]
  std::vector<double> positions;      ///< [rad]
  std::vector<double> velocities;     ///< [rad/s]
  std::vector<double> accelerations;  ///< [rad/s^2]; empty in a trajectory of time_dig_path()
};

/// What a joint trajectory controller takes, in the names and angles of the robot.
struct JointMotion {
  std::vector<std::string> names;  ///< of the joints that have one: boom, arm, bucket, swing
  std::vector<JointPoint> points;  ///< times strictly increasing
};

/// A trajectory for a robot, by Trajectory::robot_joints.
/// @throws Error (bad_input) naming a time that is not in 0 .. 2^31 - 1 s
JointMotion joint_motion(const Trajectory& trajectory);

/// A message trajectory_msgs/JointTrajectory of ROS 2 as YAML (`docs/formats.md#trajectory`).
/// @throws Error (bad_input) naming a number that is not finite or a name that is not UTF-8
std::string to_joint_trajectory(const Trajectory& trajectory);

/// Messages com3_msgs/JointCmd of OPERA's position control as YAML documents, one for each point
/// (`docs/formats.md#trajectory`). @throws Error (bad_input) likewise
std::string to_joint_commands(const Trajectory& trajectory);

}  // namespace excavplan
