// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/joint_motion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "machine/plan_stamp.hpp"

namespace excavplan {
namespace {

/// YAML 1.1, which robots' tools read, knows a number with an exponent only by its point.
std::string yaml_number(double value) {
  require(std::isfinite(value), "trajectory: a number is not finite");
  std::string text = number_text(value);
  if (text.find('.') == std::string::npos) {
    text.insert(std::min(text.find('e'), text.size()), ".0");
  }
  return text;
}

template <typename Each, typename Text>
std::string yaml_list(const std::vector<Each>& list, const Text& text) {
  std::string joined;
  for (const Each& each : list) joined += (joined.empty() ? "" : ", ") + text(each);
  return '[' + joined + ']';
}

std::string yaml(const std::vector<std::string>& names) {
  return yaml_list(names, [](const std::string& name) {
    require_storable({{"robot_joints", name}}, "trajectory");
    return json_text(name);
  });
}

std::string yaml(const std::vector<double>& numbers) { return yaml_list(numbers, yaml_number); }

std::string duration_text(std::int64_t time_ns) {
  constexpr std::int64_t second = 1'000'000'000;
  return "{sec: " + std::to_string(time_ns / second) +
         ", nanosec: " + std::to_string(time_ns % second) + "}";
}

/// A comment that states the plan; messages have no place for it.
std::string plan_line(const Trajectory& trajectory) {
  if (!trajectory.plan) return "";
  return "# plan: " + json_text(stamp_json(*trajectory.plan)) + '\n';
}

}  // namespace

JointMotion joint_motion(const Trajectory& trajectory) {
  constexpr double longest = std::numeric_limits<std::int32_t>::max();  // of a message [s]
  JointMotion motion;
  const RobotJoints& joints = trajectory.robot_joints;
  for (const RobotJoint& joint : joints) {
    if (!joint.name.empty()) motion.names.push_back(joint.name);
  }
  for (const TrajectoryPoint& point : trajectory.points) {
    JointPoint sent;
    require_in("trajectory: time [s]", point.time, 0.0, longest);
    sent.time_ns = std::llround(1e9 * point.time);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].name.empty()) continue;
      const auto j = static_cast<Eigen::Index>(i);
      const bool swings = i == 3;
      sent.positions.push_back(joints[i].from_ours(swings ? point.swing.angle : point.joints[j]));
      sent.velocities.push_back(joints[i].sign * (swings ? point.swing.rate : point.rates[j]));
      if (!point.accelerations.allFinite()) continue;
      sent.accelerations.push_back(joints[i].sign *
                                   (swings ? point.swing.acceleration : point.accelerations[j]));
    }
    motion.points.push_back(std::move(sent));
  }
  return motion;
}

std::string to_joint_trajectory(const Trajectory& trajectory) {
  const JointMotion motion = joint_motion(trajectory);
  std::string text =
      "header: {stamp: {sec: 0, nanosec: 0}, frame_id: \"\"}\njoint_names: " + yaml(motion.names) +
      "\npoints:" + (motion.points.empty() ? " []\n" : "\n");
  for (const JointPoint& point : motion.points) {
    text += "- positions: " + yaml(point.positions) + "\n  velocities: " + yaml(point.velocities);
    if (!point.accelerations.empty()) text += "\n  accelerations: " + yaml(point.accelerations);
    text += "\n  time_from_start: " + duration_text(point.time_ns) + '\n';
  }
  return text + plan_line(trajectory);
}

std::string to_joint_commands(const Trajectory& trajectory) {
  const JointMotion motion = joint_motion(trajectory);
  const std::string names = yaml(motion.names);
  const std::string none = yaml(std::vector<double>(motion.names.size(), 0.0));
  std::string text;
  for (const JointPoint& point : motion.points) {
    text += text.empty() ? "" : "---\n";
    text += "joint_name: " + names + "\ncontrol_type: 0\nposition: " + yaml(point.positions) +
            "\nvelocity: " + yaml(point.velocities) + "\neffort: " + none + '\n';
  }
  return text + plan_line(trajectory);
}

}  // namespace excavplan
