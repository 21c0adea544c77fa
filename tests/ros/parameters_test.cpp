// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The parameters of the node of ROS 2, with a node that takes them as rclcpp does: a value of
/// another type than the default is refused unless the typing is dynamic.

#include "parameters.hpp"

#include <cstdio>
#include <cstdlib>
#include <map>

namespace {

std::map<std::string, rclcpp::ParameterValue> given;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "failed: %s\n", what);
  std::exit(1);
}

template <typename Value>
std::string error_of(excavplan_ros::Parameters& parameters, const char* name, const Value& usual) {
  try {
    parameters.value(name, usual);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

rclcpp::Node::Node(const std::string&, const rclcpp::NodeOptions&) {}

const rclcpp::ParameterValue& rclcpp::Node::declare_parameter(
    const std::string& name, const ParameterValue& value,
    const rcl_interfaces::msg::ParameterDescriptor& descriptor) {
  const auto& found = given.emplace(name, value).first->second;
  if (found.get_type() != value.get_type() && !descriptor.dynamic_typing) {
    throw std::invalid_argument("parameter " + name + " has invalid type");
  }
  return found;
}

int main() {
  rclcpp::Node node("excavplan");
  excavplan_ros::Parameters parameters(node);
  given = {{"rate_hz", rclcpp::ParameterValue(std::int64_t{50})},
           {"max_jerk", rclcpp::ParameterValue(2.5)},
           {"swing", rclcpp::ParameterValue(std::string("left"))},
           {"scans", rclcpp::ParameterValue(std::int64_t{1} << 40)},
           {"search", rclcpp::ParameterValue(std::int64_t{1})}};
  expect(parameters.value("rate_hz", 100.0) == 50.0, "a whole number is a number");
  expect(parameters.value("max_jerk", 1.0) == 2.5, "a number is");
  expect(parameters.value("speed_fraction", 0.8) == 0.8, "one that is not given is the usual one");
  expect(error_of(parameters, "swing", 1.0) == "parameter swing: is not a number",
         "a text is none");
  expect(parameters.value("scans", 5) == std::numeric_limits<int>::max(), "counts do not wrap");
  expect(error_of(parameters, "search", false) == "parameter search has invalid type",
         "a number is no flag");
}
