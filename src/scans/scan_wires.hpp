// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace excavplan {

/// A straight wire in plan.
struct Wire {
  Eigen::Vector2d middle;     ///< of its returns [m]
  Eigen::Vector2d direction;  ///< unit
  double half = 0.0;          ///< from the middle to its last return [m]
  double turn = 0.0;          ///< standard deviation of the direction [rad]
  double top = 0.0;           ///< of its highest return [m]
};

/// Wires among returns with nothing below them but the ground: at least three of them on a line to
/// 0.1 m in plan, whose surroundings are no wider than a line.
std::vector<Wire> find_wires(const std::vector<Eigen::Vector3d>& hanging);

}  // namespace excavplan
