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

excavplan::JointNames joint_names(Parameters& parameters) {
  excavplan::JointNames names = excavplan::opera_joint_names();
  const auto given =
      parameters.value("joint_names", std::vector<std::string>(names.begin(), names.end()));
  if (given.size() != names.size()) {
    throw Error(ErrorKind::bad_input, "parameter joint_names: has " + std::to_string(given.size()) +
                                          " names, must have 4: swing, boom, arm, bucket");
  }
  std::copy(given.begin(), given.end(), names.begin());
  return names;
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
  settings.joint_names = joint_names(parameters);
  settings.machine_in_view = parameters.value("machine_in_view", settings.machine_in_view);
  settings.digs_as_planned = parameters.value("digs_as_planned", settings.digs_as_planned);
  if (parameters.value("search", false)) settings.plan.method = excavplan::PlanMethod::search;
  double& speed = settings.plan.trajectory.speed_fraction;
  speed = parameters.value("speed_fraction", speed);
  parameters.done();
  return settings;
}

}  // namespace excavplan_ros
