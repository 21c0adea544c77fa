// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include <Eigen/Core>

#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// Where the sensor of a scan stood, as the scan itself tells.
///
/// Kept as (x, y, 1) / h about the middle of the scan, h the height above it: in these the way of a
/// ray per unit of fall is nearly linear, and they are 0 where the points lie even in plan.
class SensorPlace {
 public:
  SensorPlace(Eigen::Vector3d middle, Eigen::Vector3d inverse, Eigen::Matrix3d covariance)
      : middle_(std::move(middle)),
        inverse_(std::move(inverse)),
        covariance_(std::move(covariance)) {}

  /// In the frame of the heights [m].
  Eigen::Vector3d place() const;
  /// Standard deviation of the level way of a ray to a point per unit of its fall, along the way.
  double tangent_sd(const Eigen::Vector3d& point) const;
  /// By how many standard deviations the ways of the rays from another place differ from those from
  /// this one, where they differ most over an area; infinite for a place below the ground [-].
  double misfit(const Eigen::Vector3d& place, const Rectangle& area) const;

 private:
  Eigen::Vector3d middle_;
  Eigen::Vector3d inverse_;     ///< [-, -, 1/m]
  Eigen::Matrix3d covariance_;  ///< of it
};

/// Finds the place of the one sensor of a scan by the points on slopes.
///
/// On ground with the gradient g a smooth pattern of rays leaves 1 + g.v times the points per plan
/// area of level ground, v the level way of the rays per unit of their fall: more where the ground
/// faces the sensor, fewer where it faces away. The points on level ground are taken as a smooth
/// function of the place, so that they need no pattern of rays. @return nothing where the relief
/// tells no place: points even in plan, thinned clouds, level ground, few points
std::optional<SensorPlace> infer_sensor(const Surface& surface);

/// What speaks against the one place where the sensor of a scan is said to have stood.
struct PlaceDoubt {
  Eigen::Vector3d told;
  std::optional<Eigen::Vector3d> inferred;  ///< where it was; none: below the ground it was not
};
/// Nothing where the scan tells no place, or more than one is said.
std::optional<PlaceDoubt> doubt_of_place(const Surface& surface);

}  // namespace excavplan
