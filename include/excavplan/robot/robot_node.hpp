// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/robot/dig_cycle_session.hpp>
#include <excavplan/robot/job_session.hpp>
#include <excavplan/robot/node_settings.hpp>

/// @file
/// What the nodes of ROS 1 and ROS 2 share besides their parameters, as templates of their messages
/// (docs/ros.md).

namespace excavplan {

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
/// The same of the scan of a step.
inline std::string early_text(const JobSession& session) {
  return "points were measured before the motion was over and are left out: " + describe(session);
}

/// Remembers whether early points of a scan were told.
class EarlyPoints {
 public:
  /// Whether they are to be told now: once of each scan. @param session  a DigCycleSession or
  /// JobSession
  template <typename Session>
  bool are_news(const Session& session) {
    const bool were_told = std::exchange(are_told_, session.early_scans() > 0);
    return are_told_ && !were_told;
  }

 private:
  bool are_told_ = false;
};

/// "code: text" of each.
inline std::vector<std::string> texts_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings)
    texts.push_back(code_text(warning.code) + ": " + warning.message);
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
