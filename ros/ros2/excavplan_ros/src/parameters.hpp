// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <rclcpp/rclcpp.hpp>

namespace excavplan_ros {

/// Parameters of a node by name, each of its type; a whole number is a number too.
class Parameters {
 public:
  explicit Parameters(rclcpp::Node& node) : node_(node) {}

  template <typename Value>
  Value value(const std::string& name, const Value& fallback) {
    if constexpr (std::is_same_v<Value, double>) {
      return number(name, fallback);
    } else if constexpr (std::is_same_v<Value, int>) {
      constexpr std::int64_t most = std::numeric_limits<int>::max();
      const auto count = node_.declare_parameter<std::int64_t>(name, fallback);
      return static_cast<int>(std::clamp<std::int64_t>(count, -1, most));
    } else {
      return node_.declare_parameter<Value>(name, fallback);
    }
  }

 private:
  /// `rate_hz:=100` is a whole number, which a parameter that was declared as a double refuses.
  double number(const std::string& name, double fallback) {
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.dynamic_typing = true;
    const rclcpp::ParameterValue given =
        node_.declare_parameter(name, rclcpp::ParameterValue(fallback), descriptor);
    switch (given.get_type()) {
      case rclcpp::ParameterType::PARAMETER_INTEGER:
        return static_cast<double>(given.get<std::int64_t>());
      case rclcpp::ParameterType::PARAMETER_DOUBLE:
        return given.get<double>();
      default:
        throw std::invalid_argument("parameter " + name + ": is not a number");
    }
  }

  rclcpp::Node& node_;
};

}  // namespace excavplan_ros
