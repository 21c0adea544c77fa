// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/controller/dig_cycle_session.hpp>
#include <excavplan/survey/cloud.hpp>

/// @file
/// What the nodes of ROS 1 and ROS 2 share, as templates of their parameters and messages
/// (docs/ros.md).

namespace excavplan {

/// Settings of a node.
struct NodeSettings {
  DigCycleSettings session;    ///< of the dig cycle
  bool send_doubtful = false;  ///< the trajectory is sent even if it is not a safe_motion()
};

/// The settings that parameters give (docs/ros.md#parameters).
/// @param parameters  has `value(name, fallback)` for texts, numbers, flags, counts (int) and lists
/// of texts
/// @throws Error as shipped_settings() and read_frame(), or (bad_input) naming a parameter
template <typename Parameters>
NodeSettings settings_of(Parameters& parameters) {
  const auto text = [&](const char* name, const std::string& usual) {
    return parameters.value(name, usual);
  };
  NodeSettings node = {
      shipped_settings(text("machine", "zx120"), text("soil", "loam"), text("law", ""))};
  DigCycleSettings& settings = node.session;
  const auto read = [&](const char* name, auto& value) { value = parameters.value(name, value); };
  double percent = settings.density.percent, sd_percent = settings.density.sd_percent;
  read("density_percent", percent);
  read("density_sd_percent", sd_percent);
  settings.density = {percent, sd_percent};
  const int scans = parameters.value("scans", static_cast<int>(settings.scans));
  settings.scans = scans > 0 ? static_cast<std::size_t>(scans) : 0;
  read("site_frame", settings.site_frame);
  const std::string frame_file = text("frame_file", "");
  if (!frame_file.empty()) settings.site_from_scan = read_frame(frame_file);
  RobotJoints& joints = settings.machine.robot_joints;
  std::vector<std::string> names;
  for (const RobotJoint& joint : joints) names.push_back(joint.name);
  read("joint_names", names);
  if (names.size() != joints.size()) {
    throw Error(ErrorKind::bad_input, "parameter joint_names: has " + std::to_string(names.size()) +
                                          " names, must have 4: boom, arm, bucket, swing");
  }
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = names[i];
  read("machine_in_view", settings.machine_in_view);
  read("digs_as_planned", settings.digs_as_planned);
  read("joint_age_seconds", settings.oldest_joints);
  if (parameters.value("search", false)) settings.plan.method = PlanMethod::search;
  read("search_seconds", settings.search_seconds);
  if (std::isfinite(settings.search_seconds) && settings.plan.method != PlanMethod::search) {
    throw Error(ErrorKind::bad_input, "parameter search_seconds: has no effect without search");
  }
  read("whole_cycle", settings.whole_cycle);
  read("rate_hz", settings.motion.rate);
  read("max_jerk", settings.motion.max_jerk);
  read("speed_fraction", settings.motion.speed_fraction);
  settings.plan.trajectory.speed_fraction = settings.motion.speed_fraction;
  read("send_doubtful", node.send_doubtful);
  return node;
}

/// The motion that may go to a controller: without points unless the plan is to be trusted and
/// begins where the machine stands.
inline JointMotion safe_motion(const CyclePlan& plan) {
  JointMotion motion = plan.motion;
  if (!plan.trustworthy || !plan.posture_known) motion.points.clear();
  return motion;
}

/// A trajectory_msgs/JointTrajectory.
/// @param set_time  (duration of the message, nanoseconds): a duration is of another type in each
template <typename Message, typename SetTime>
Message joint_trajectory_message(const JointMotion& motion, const SetTime& set_time) {
  Message message;
  message.joint_names = motion.names;
  message.points.resize(motion.points.size());
  for (std::size_t i = 0; i < motion.points.size(); ++i) {
    const JointPoint& point = motion.points[i];
    auto& sent = message.points[i];
    sent.positions = point.positions;
    sent.velocities = point.velocities;
    sent.accelerations = point.accelerations;
    set_time(sent.time_from_start, point.time_ns);
  }
  return message;
}

/// Of the clock of a node, which is at 0 until simulated time begins [ns].
inline std::optional<std::int64_t> known_time(std::int64_t now) {
  return now > 0 ? std::optional(now) : std::nullopt;
}

/// What to tell where points are left out that came too late.
inline std::string early_text(const DigCycleSession& session) {
  return "points were measured before the dig was over and are left out: " + describe(session);
}

/// "code: text" of each.
inline std::vector<std::string> texts_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.code + ": " + warning.message);
  return texts;
}

/// What Estimate.srv answers, but for warnings and message.
template <typename Response>
void fill_estimate(const CycleEstimate& answer, Response& response) {
  response.success = true;
  response.trustworthy = answer.adopted;
  if (answer.estimate.density) {
    response.density_percent = answer.estimate.density->percent;
    response.density_sd_percent = answer.estimate.density->sd_percent;
  }
  if (answer.estimate.bulking) response.bulking_factor = answer.estimate.bulking->value;
  response.json = to_json(answer);
}

/// What Plan.srv and DigAndPlan.srv answer of a plan, but for trajectory and warnings.
template <typename Response>
void fill_plan(const CyclePlan& answer, Response& response) {
  response.success = answer.plan.dig.has_value();
  response.message = answer.plan.reason;
  response.trustworthy = answer.trustworthy;
  response.previous_density = answer.previous_density;
  response.density_percent = answer.density.percent;
  response.json = to_json(answer);
}

}  // namespace excavplan
