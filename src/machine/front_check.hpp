// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include <excavplan/machine/way.hpp>

#include "base/check.hpp"

/// @file Private to the project.

namespace excavplan {

constexpr double most_swing = 1e4;  ///< of an encoder that counts its turns; ours [rad]

/// Joints within their limits, the swing too. @param rounding  by which they may be beyond [rad]
/// @throws Error (bad_input) "WHAT: boom [rad] is ..."
inline void check_joints(const Machine& machine, const FrontJoints& joints, const std::string& what,
                         double rounding = 0.0) {
  const auto check = [&](const char* joint, double angle, double lower, double upper) {
    if (angle >= lower - rounding && angle <= upper + rounding) return;
    require_in(what + ": " + joint + " [rad]", angle, lower, upper);
  };
  for (std::size_t i = 0; i < machine.limits.size(); ++i) {
    const JointLimits& limits = machine.limits[i];
    check(name(static_cast<Joint>(i)), joints[static_cast<Eigen::Index>(i)], limits.lower,
          limits.upper);
  }
  const Swing swing = machine.swing.value_or(Swing{});
  check("swing", joints[3], std::max(swing.lower, -most_swing), std::min(swing.upper, most_swing));
}

}  // namespace excavplan
