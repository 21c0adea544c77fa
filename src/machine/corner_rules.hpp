// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/kinematics.hpp>

#include "base/check.hpp"
#include "base/text.hpp"

/// @file What trajectories and motions have in common at corners. Private to the project.

namespace excavplan {

constexpr double standstill = 1e-9;      ///< poses closer than this count as one [rad]
constexpr double shortest_reach = 1e-5;  ///< of a rounding; a shorter one gains nothing, ours [rad]
constexpr double sharpest_turn = -0.5;   ///< cosine of the turn beyond which the machine stops

/// Tip travel per joint motion [m/rad], or that of the attitude times the length of the bucket if
/// it is larger.
inline double bucket_motion(const Machine& machine, const JointAngles& joints,
                            const JointAngles& motion, double swing = 0.0) {
  const LinkPositions at = link_positions(machine, joints);
  const auto about = [&](const Eigen::Vector2d& pin) -> Eigen::Vector2d {
    return {at.tip.y() - pin.y(), pin.x() - at.tip.x()};
  };
  const Eigen::Vector2d tip = motion[0] * about(machine.boom_pin) + motion[1] * about(at.arm_pin) +
                              motion[2] * about(at.bucket_pin);
  return std::max(std::hypot(tip.norm(), swing * at.tip.x()),
                  std::abs(motion.sum()) * machine.bucket_length);
}

/// Options of both. @throws Error (bad_input)
inline void check_timing(const std::string& options, double speed_fraction,
                         double corner_tolerance) {
  constexpr double largest_tolerance = 0.01;  // [m]
  require(speed_fraction > 0.0 && speed_fraction <= 1.0, options + "::speed_fraction",
          speed_fraction, "above 0 and at most 1");
  require(corner_tolerance >= 0.0 && corner_tolerance <= largest_tolerance,
          options + "::corner_tolerance", corner_tolerance,
          "in 0 .. " + number_text(largest_tolerance) + " m");
}

/// Of a path along which they act. @throws Error (bad_input)
inline void check_torques(const DigPath& path, std::size_t torques) {
  const std::string poses = std::to_string(path.poses.size()) + " poses, must ";
  require(path.poses.size() >= 2, "the dig path has " + poses + "have at least 2");
  require(torques < path.poses.size(),
          "there are " + std::to_string(torques) + " torques between " + poses + "be fewer");
}

}  // namespace excavplan
