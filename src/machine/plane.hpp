// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

/// @file
/// Vectors in the boom plane. Private to the project.

namespace excavplan {

/// Positive if b points to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Unit vector, counter-clockwise from +x.
inline Eigen::Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace excavplan
