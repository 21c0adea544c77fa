// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/angles.hpp"

/// @file
/// Lines and polygons in plan. Private to the project.

namespace excavplan {

/// Along a line and to the left of it.
class PlanFrame {
 public:
  PlanFrame(Eigen::Vector2d origin, double heading)
      : origin_(std::move(origin)), ahead_(std::cos(heading), std::sin(heading)) {}

  Eigen::Vector2d place(double along, double left) const {
    return origin_ + along * ahead_ + left * to_left();
  }
  /// (along, left) of a place.
  Eigen::Vector2d of(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d off = place - origin_;
    return {off.dot(ahead_), off.dot(to_left())};
  }

 private:
  Eigen::Vector2d to_left() const { return {-ahead_.y(), ahead_.x()}; }

  Eigen::Vector2d origin_, ahead_;
};

/// Whether a place lies in a polygon, by the crossings of a ray along x.
inline bool is_inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

/// Of a place from the nearest point of a side from a to b.
inline double distance_to_side(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                               const Eigen::Vector2d& b) {
  const Eigen::Vector2d side = b - a;
  const double length = side.squaredNorm();
  const double along = length > 0.0 ? std::clamp((p - a).dot(side) / length, 0.0, 1.0) : 0.0;
  return (p - a - along * side).norm();
}

/// Whether a place lies in a polygon or less than so far from it: of the middles of cells and half
/// their size, so that no polygon is too narrow to be seen on a grid.
inline bool is_near(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& at,
                    double away) {
  constexpr double rounding = 1e-9;
  if (is_inside(polygon, at)) return true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& next = polygon[(i + 1) % polygon.size()];
    if (distance_to_side(at, polygon[i], next) < away - rounding) return true;
  }
  return false;
}

/// Whether it lies in a polygon with eight places so far around it.
inline bool is_well_in(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& at,
                       double margin) {
  constexpr int ways = 8;
  for (int i = 0; i < ways; ++i) {
    const double angle = 2.0 * pi * i / ways;
    if (!is_inside(polygon, at + margin * Eigen::Vector2d(std::cos(angle), std::sin(angle))))
      return false;
  }
  return true;
}

}  // namespace excavplan
