// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

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

/// Every corner lies to the left of every side that it is not on: the polygon turns left at every
/// corner and goes round once, so that it is convex, counter-clockwise and without crossings.
inline bool is_convex(const std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  const auto goes_up = [](const Eigen::Vector2d& side) {
    return side.y() > 0.0 || (side.y() == 0.0 && side.x() > 0.0);
  };
  int rounds = 0;
  Eigen::Vector2d before = polygon[0] - polygon[n - 1];
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d side = polygon[i + 1 < n ? i + 1 : 0] - polygon[i];
    if (!(cross(before, side) > 0.0)) return false;
    if (goes_up(side) && !goes_up(before)) ++rounds;
    before = side;
  }
  return rounds == 1;
}

}  // namespace excavplan
