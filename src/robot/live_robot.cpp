// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/live_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/check.hpp"
#include "base/text.hpp"
#include "recording/times.hpp"

namespace excavplan {
namespace {

// Of a joint that stands still [rad]: what MoveIt allows by default between joint states and the
// first point of a trajectory (trajectory_execution/allowed_start_tolerance).
constexpr double most_turn = 0.01;

}  // namespace

double seconds_between(std::int64_t from, std::int64_t to) {
  return 1e-9 * (static_cast<double>(to) - static_cast<double>(from));
}

bool is_set_back(const RobotMessage& message, LiveTime mark) {
  constexpr std::int64_t most = 1'000'000'000;  // the clock, not the order of messages; ours
  return message.received && mark && *message.received < later(*mark, -most);
}

std::string count_text(std::size_t found, std::size_t wanted) {
  return std::to_string(found) + " of " + std::to_string(wanted);
}

std::string scans_text(std::size_t found, std::size_t wanted, std::size_t early) {
  const std::string text = count_text(found, wanted);
  return early == 0 ? text : text + ", " + std::to_string(early) + " too early";
}

void name_joints(const std::vector<std::string>& names, RobotJoints& joints,
                 const std::string& where) {
  if (names.empty()) return;
  require(names.size() == joints.size(), where + "has " + std::to_string(names.size()) +
                                             " names, must have 4: boom, arm, bucket, swing");
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = names[i];
  for (std::size_t i = 0; i < 3; ++i) {
    require(!names[i].empty(), where + "boom, arm and bucket need a name");
  }
}

/// When a message with this stamp was measured.
LiveTime LiveRobot::time_of(const RobotMessage& message, std::int64_t stamp) {
  return clocks_[message.topic].time(stamp, message.received);
}

/// @param time  of the message, if it does not tell when it was received
void LiveRobot::come(const RobotMessage& message, LiveTime time) {
  if (message.received) {
    now_ = message.received;
  } else if (time && (!now_ || *time > *now_)) {
    now_ = time;
  }
}

std::optional<LiveFrame> LiveRobot::take(const RobotMessage& message) {
  const RecordedTopic topic = {message.topic, message.type, 1, 0, 0};
  const RecordedMessage raw = {topic, 0, message.is_cdr ? Serialization::cdr : Serialization::ros1,
                               message.bytes, "message"};
  const std::string& from = message.topic;
  switch (use_of(message.type)) {
    case MessageUse::points: {
      LiveFrame frame;
      frame.header = decode_header(from, raw);
      frame.points = decode_points(from, raw);
      frame.measured = time_of(message, frame.header.stamp);
      come(message, frame.measured);
      frame.time = frame.measured.value_or(now_.value_or(0));
      if (settings_.site_frame.empty()) frame.pose = Eigen::Isometry3d(settings_.site_from_scan);
      return frame;
    }
    case MessageUse::transforms: {
      auto transforms = decode_transforms(from, raw);
      for (const StampedTransform& transform : transforms) {
        come(message, transform.is_static ? LiveTime() : transform.stamp);
      }
      transforms_.add(std::move(transforms));
      return {};
    }
    case MessageUse::joints: {
      const auto positions = decode_joints(from, raw);
      const LiveTime time = time_of(message, decode_header(from, raw).stamp);
      come(message, time);
      take_joints(positions, time);
      return {};
    }
    default:
      throw Error(ErrorKind::bad_file, from + ": found a message of " + message.type +
                                           ", expected points, transforms or joint states");
  }
}

void LiveRobot::take_joints(const std::vector<std::pair<std::string, double>>& positions,
                            LiveTime time) {
  for (const auto& [name, position] : positions) {
    if (name.empty() || !std::isfinite(position)) continue;
    for (const RobotJoint& joint : settings_.machine.robot_joints) {
      if (joint.name == name) joints_.add(name, {time.value_or(now_.value_or(0)), position});
    }
  }
}

/// @param at  nothing: the newest
std::optional<JointSample> LiveRobot::sample(const std::string& joint, LiveTime at) const {
  return joints_.nearest(joint, at.value_or(std::numeric_limits<std::int64_t>::max()));
}

std::string LiveRobot::joint_problem(LiveTime at) const {
  const std::int64_t time = at.value_or(now_.value_or(0));
  for (const RobotJoint& joint : settings_.machine.robot_joints) {
    if (joint.name.empty()) continue;
    const auto found = sample(joint.name, at);
    if (!found) return "no joint states came of " + joint.name;
    const double away = std::abs(seconds_between(found->time, time));
    if (away <= settings_.oldest_joints) continue;
    return "no joint states of " + joint.name + " came within " +
           plain_number(settings_.oldest_joints) + " s, the nearest is " + readable(away) +
           " s away";
  }
  return "";
}

std::string LiveRobot::moving_problem() const {
  constexpr std::int64_t span = 500'000'000;  // [ns]; ours
  for (const RobotJoint& joint : settings_.machine.robot_joints) {
    if (joint.name.empty()) continue;
    const auto turned = joints_.turned(joint.name, span);
    if (!turned) {
      return "the joint states of " + joint.name + " reach back less than " +
             plain_number(seconds_between(0, span)) + " s: whether it stands still is not known";
    }
    if (*turned <= most_turn) continue;
    return joint.name + " turned by " + readable(*turned) + " rad within the last " +
           plain_number(seconds_between(0, span)) + " s";
  }
  return "";
}

std::string LiveRobot::start_problem(const JointMotion& motion) const {
  const std::optional<FrontJoints> present = start();
  if (!present) return joint_problem({});
  std::size_t sent = 0;
  for (std::size_t i = 0; i < settings_.machine.robot_joints.size(); ++i) {
    const RobotJoint& joint = settings_.machine.robot_joints[i];
    if (joint.name.empty()) continue;
    const double stands = joint.from_ours((*present)[static_cast<Eigen::Index>(i)]);
    const double off = std::abs(stands - motion.points.front().positions[sent++]);
    if (off <= most_turn) continue;
    return joint.name + " stands " + readable(off) + " rad from there";
  }
  return "";
}

std::optional<MachinePosture> LiveRobot::posture(LiveTime at) const {
  if (!joint_problem(at).empty()) return {};
  FrontJoints angles = FrontJoints::Zero();
  for (std::size_t i = 0; i < settings_.machine.robot_joints.size(); ++i) {
    const RobotJoint& joint = settings_.machine.robot_joints[i];
    if (joint.name.empty()) continue;
    angles[static_cast<Eigen::Index>(i)] = joint.to_ours(sample(joint.name, at)->position);
  }
  return MachinePosture{angles[3], angles.head<3>()};
}

std::optional<FrontJoints> LiveRobot::start() const {
  constexpr double most_beyond = 0.02;  // ours [rad]
  const std::optional<MachinePosture> present = posture({});
  if (!present) return {};
  FrontJoints start;
  start << present->joints, present->swing;
  for (std::size_t i = 0; i < settings_.machine.limits.size(); ++i) {
    const JointLimits& limits = settings_.machine.limits[i];
    double& angle = start[static_cast<Eigen::Index>(i)];
    const double inside = std::clamp(angle, limits.lower, limits.upper);
    if (std::abs(angle - inside) < most_beyond) angle = inside;
  }
  return start;
}

void LiveRobot::settle(std::vector<LiveFrame>& frames, bool all) const {
  const auto known = [](const LiveFrame& frame) { return frame.pose.has_value(); };
  if (std::all_of(frames.begin(), frames.end(), known)) return;
  const TransformTree tree = transforms_.tree();
  for (LiveFrame& frame : frames) {
    if (frame.pose) continue;
    try {
      const MessageHeader& header = frame.header;
      frame.pose = Eigen::Isometry3d(settings_.site_from_scan) *
                   tree.lookup(settings_.site_frame, header.frame, header.stamp);
      frame.from_sensor = tree.is_leaf(header.frame);
    } catch (const Error&) {
      if (all) throw;
    }
  }
}

void LiveRobot::settle_postures(std::vector<LiveFrame>& frames, bool all) const {
  if (!settings_.machine_in_view) return;
  const RobotJoints& robot = settings_.machine.robot_joints;
  for (LiveFrame& frame : frames) {
    if (frame.posture) continue;
    const bool reached = std::all_of(robot.begin(), robot.end(), [&](const RobotJoint& joint) {
      return joint.name.empty() || joints_.reaches(joint.name, frame.time);
    });
    if (reached || all) frame.posture = posture(frame.time);
  }
}

bool LiveRobot::is_settled(const std::vector<LiveFrame>& frames) const {
  return std::all_of(frames.begin(), frames.end(), [&](const LiveFrame& frame) {
    return frame.pose && (frame.posture || !settings_.machine_in_view);
  });
}

Scan LiveRobot::scan_of(std::vector<LiveFrame>& frames, const std::string& name,
                        bool& averaged) const {
  settle(frames, true);
  settle_postures(frames, true);
  LiveScan live = merged(frames);
  averaged = averaged && (live.averaged || frames.size() == 1);
  Scan scan;
  scan.name = name;
  scan.clouds = {std::make_shared<const Cloud>(std::move(live.cloud))};
  scan.z_is_up = !settings_.site_frame.empty() || !settings_.site_from_scan.isIdentity(0.0);
  if (settings_.machine_in_view) {
    const LiveFrame& first = frames.front();
    require(first.posture.has_value(),
            scan.name + ": the machine is in view, but " + joint_problem(first.time));
    scan.machine = std::make_shared<const MachineFront>(settings_.machine, *first.posture);
  }
  return scan;
}

}  // namespace excavplan
