// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "parameters.hpp"

#include <algorithm>

#include <excavplan/robot/robot_node.hpp>

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

}  // namespace

excavplan::NodeSettings settings_of(const ros::NodeHandle& node) {
  Parameters parameters(node);
  excavplan::NodeSettings settings = excavplan::settings_of(parameters);
  parameters.done();
  return settings;
}

excavplan::JobSessionSettings job_settings_of(const ros::NodeHandle& node) {
  Parameters parameters(node);
  excavplan::JobSessionSettings settings = excavplan::job_settings_of(parameters);
  parameters.done();
  return settings;
}

}  // namespace excavplan_ros
