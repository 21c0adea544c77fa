// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <excavplan/machine/motion.hpp>
#include <excavplan/machine/trajectory.hpp>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"

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

/// Of the joints that have a name.
class Joints {
 public:
  explicit Joints(const std::array<std::string, 4>& names) : names_(names) {}

  std::string names() const {
    return list([&](std::size_t i) {
      require_storable({{"joint_names", names_[i]}}, "trajectory");
      return json_text(names_[i]);
    });
  }
  std::string numbers(const JointAngles& front, double swing) const {
    return list([&](std::size_t i) {
      return yaml_number(i < 3 ? front[static_cast<Eigen::Index>(i)] : swing);
    });
  }

 private:
  template <typename Text>
  std::string list(const Text& text) const {
    std::string joined;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (!names_[i].empty()) joined += (joined.empty() ? "" : ", ") + text(i);
    }
    return '[' + joined + ']';
  }

  const std::array<std::string, 4>& names_;
};

std::string duration_text(double time) {
  constexpr std::int64_t nano = 1000000000;
  const auto all = static_cast<std::int64_t>(std::llround(time * static_cast<double>(nano)));
  return "{sec: " + std::to_string(all / nano) + ", nanosec: " + std::to_string(all % nano) + "}";
}

}  // namespace

std::string to_joint_trajectory(const Trajectory& trajectory) {
  const Joints joints(trajectory.joint_names);
  std::string yaml =
      "header: {stamp: {sec: 0, nanosec: 0}, frame_id: \"\"}\njoint_names: " + joints.names() +
      "\npoints:" + (trajectory.points.empty() ? " []\n" : "\n");
  for (const TrajectoryPoint& point : trajectory.points) {
    const SwingState& swing = point.swing;
    yaml += "- positions: " + joints.numbers(point.joints, swing.angle) +
            "\n  velocities: " + joints.numbers(point.rates, swing.rate);
    if (point.accelerations.allFinite()) {
      yaml += "\n  accelerations: " + joints.numbers(point.accelerations, swing.acceleration);
    }
    yaml += "\n  time_from_start: " + duration_text(point.time) + '\n';
  }
  return yaml;
}

std::string to_joint_commands(const Trajectory& trajectory) {
  const Joints joints(trajectory.joint_names);
  const std::string names = joints.names(), none = joints.numbers(JointAngles::Zero(), 0.0);
  std::string yaml;
  for (const TrajectoryPoint& point : trajectory.points) {
    yaml += (yaml.empty() ? "" : "---\n");
    yaml += "joint_name: " + names +
            "\ncontrol_type: 0\nposition: " + joints.numbers(point.joints, point.swing.angle) +
            "\nvelocity: " + joints.numbers(point.rates, point.swing.rate) + "\neffort: " + none +
            '\n';
  }
  return yaml;
}

}  // namespace excavplan
