// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "base/normal_equations.hpp"

/// @file
/// Planes as height over ground. Private to the project.

namespace excavplan {

/// z = height + gradient . (x, y), in metres or cells as the points were.
struct GroundPlane {
  Eigen::Vector3d terms = Eigen::Vector3d::Zero();  ///< height at the origin, slope along x, y

  double at(double x, double y) const { return terms.dot(Eigen::Vector3d(1.0, x, y)); }
  Eigen::Vector2d gradient() const { return terms.tail<2>(); }
};

/// The plane of least squares of heights.
class PlaneFit {
 public:
  void add(double x, double y, double z) { equations_.add({1.0, x, y}, z); }

  double count() const { return equations_.matrix()(0, 0); }
  /// Of the points, at least one.
  Eigen::Vector3d mean() const;
  /// Through at least three points that do not lie on one line.
  GroundPlane plane() const { return {equations_.solution()}; }
  /// Sum of the squared heights over the plane of the fit.
  double squares_about(const GroundPlane& plane) const;
  /// 0 where the points lie on one line, which no plane is told by.
  double reciprocal_condition() const { return equations_.reciprocal_condition(); }

 private:
  NormalEquations<3> equations_;
};

struct RobustPlane {
  GroundPlane plane;
  double sd = 0.0;  ///< robust, of the points about it
};

/// By least squares of the points (x, y, z), at least three, in four rounds without those that lie
/// more than 2.5 sd off the plane of the last.
RobustPlane robust_plane(const std::vector<Eigen::Vector3d>& points);

}  // namespace excavplan
