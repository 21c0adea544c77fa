// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "parameters.hpp"

#include <algorithm>

#include <excavplan/survey/cloud.hpp>

namespace excavplan_ros {
namespace {

using excavplan::Error;
using excavplan::ErrorKind;

/// Parameters by name, each of its type.
class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& node) : node_(node) {}

  template <typename Value>
  Value value(const std::string& name, Value fallback) {
    known_.push_back(node_.resolveName(name));
    Value value = fallback;
    if (!node_.hasParam(name) || node_.getParam(name, value)) return value;
    throw Error(ErrorKind::bad_input, "parameter " + name + ": is not of its type");
  }

  /// @throws Error naming a parameter that nothing read
  void done() const {
    std::vector<std::string> names;
    node_.getParamNames(names);
    const std::string own = node_.getNamespace() + "/";
    for (const std::string& name : names) {
      if (name.compare(0, own.size(), own) != 0) continue;
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      throw Error(ErrorKind::bad_input, "parameter " + name + ": is not known");
    }
  }

 private:
  const ros::NodeHandle& node_;
  std::vector<std::string> known_;
};

void name_joints(Parameters& parameters, excavplan::RobotJoints& joints) {
  std::vector<std::string> names;
  for (const excavplan::RobotJoint& joint : joints) names.push_back(joint.name);
  names = parameters.value("joint_names", names);
  if (names.size() != joints.size()) {
    throw Error(ErrorKind::bad_input, "parameter joint_names: has " + std::to_string(names.size()) +
                                          " names, must have 4: boom, arm, bucket, swing");
  }
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = names[i];
}

}  // namespace

excavplan::DigCycleSettings settings_of(const ros::NodeHandle& node) {
  Parameters parameters(node);
  auto settings = excavplan::shipped_settings(parameters.value<std::string>("machine", "zx120"),
                                              parameters.value<std::string>("soil", "loam"),
                                              parameters.value<std::string>("law", ""));
  settings.density = {parameters.value("density_percent", settings.density.percent),
                      parameters.value("density_sd_percent", settings.density.sd_percent)};
  const int scans = parameters.value("scans", static_cast<int>(settings.scans));
  settings.scans = scans > 0 ? static_cast<std::size_t>(scans) : 0;
  settings.site_frame = parameters.value<std::string>("site_frame", "");
  const auto frame_file = parameters.value<std::string>("frame_file", "");
  if (!frame_file.empty()) settings.site_from_scan = excavplan::read_frame(frame_file);
  name_joints(parameters, settings.machine.robot_joints);
  settings.machine_in_view = parameters.value("machine_in_view", settings.machine_in_view);
  settings.digs_as_planned = parameters.value("digs_as_planned", settings.digs_as_planned);
  if (parameters.value("search", false)) settings.plan.method = excavplan::PlanMethod::search;
  settings.whole_cycle = parameters.value("whole_cycle", settings.whole_cycle);
  excavplan::MotionOptions& motion = settings.motion;
  motion.rate = parameters.value("rate_hz", motion.rate);
  motion.max_jerk = parameters.value("max_jerk", motion.max_jerk);
  motion.speed_fraction = parameters.value("speed_fraction", motion.speed_fraction);
  settings.plan.trajectory.speed_fraction = motion.speed_fraction;
  parameters.done();
  return settings;
}

}  // namespace excavplan_ros
