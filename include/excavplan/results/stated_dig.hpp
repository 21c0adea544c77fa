// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include <excavplan/machine/dig_parameters.hpp>

namespace excavplan {

/// What is taken of a result of plan-path or simulate-dig about the dig that was then driven.
struct StatedDig {
  DigParameters path;                      ///< in the plane y = 0 of the machine
  std::optional<double> start_x;           ///< where it enters the ground [m]
  std::optional<Eigen::Vector2d> dump_at;  ///< where the bucket was emptied [m]
  bool is_plan = false;          ///< of plan-path, which foretells; else the simulator dug
  double density_percent = 0.0;  ///< that the dig was planned for, or was of
  double joint_work = 0.0;       ///< of the joints [J]
  bool stalled = false;          ///< the simulator gave it up
};

/// @throws Error (bad_file) naming file, key, value and rule, also if it says that there is no dig
StatedDig stated_dig(const std::string& file);

}  // namespace excavplan
