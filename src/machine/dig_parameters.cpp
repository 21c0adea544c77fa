// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/dig_parameters.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"

namespace excavplan {

DigParameters paper_fixed_path() { return {pi / 4.0, 0.35, 1.5}; }

const std::vector<DigParameterInfo>& dig_parameter_table() {
  static const std::vector<DigParameterInfo> table = {
      {"penetration_angle_rad", "rad", "penetration angle", "angle",
       &DigParameters::penetration_angle, 0.2, 1.4},
      {"penetration_length_m", "m", "penetration length", "penetration",
       &DigParameters::penetration_length, 0.1, 0.9},
      {"drag_length_m", "m", "drag length", "drag", &DigParameters::drag_length, 0.3, 3.0},
  };
  return table;
}

Eigen::VectorXd to_vector(const DigParameters& parameters) {
  const auto& table = dig_parameter_table();
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(table.size()));
  for (std::size_t i = 0; i < table.size(); ++i) {
    numbers[static_cast<Eigen::Index>(i)] = parameters.*table[i].field;
  }
  return numbers;
}

DigParameters to_dig_parameters(const Eigen::VectorXd& numbers) {
  const auto& table = dig_parameter_table();
  require(numbers.size() >= static_cast<Eigen::Index>(table.size()), "count of numbers of a dig",
          static_cast<double>(numbers.size()), "that of the table or more");
  DigParameters parameters;
  for (std::size_t i = 0; i < table.size(); ++i) {
    parameters.*table[i].field = numbers[static_cast<Eigen::Index>(i)];
  }
  return parameters;
}

}  // namespace excavplan
