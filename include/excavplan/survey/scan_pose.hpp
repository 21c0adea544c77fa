// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <excavplan/survey/cloud.hpp>

/// @file
/// Where a sensor stood, told from its own scan: upright from the plane of the ground, or wholly
/// from points whose place in the site is known.

namespace excavplan {

/// A pose that knows which way is up, how high the sensor stands, and nothing else.
struct LevelPose {
  /// Origin on the ground below the sensor, z up from the ground, x where the sensor looks (its z
  /// axis; where it looks down within 5 deg, the upper side of its image, -y).
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();
  double height = 0.0;        ///< of the sensor above the ground [m]
  double tilt = 0.0;          ///< between the sensor's axis and straight down [rad]
  double residual_sd = 0.0;   ///< of the ground about its plane [m]
  double ground_share = 0.0;  ///< of the finite points, on the plane [-]
};

/// Levels a scan by its largest plane, which must be the ground: RANSAC within 1 % of the median
/// range, then least squares over the points within 2.5 robust sd until they stay the same. Points
/// count with 1 / range^4, as stereo errs. Same seed, same pose.
///
/// Ground that slopes is levelled too: volumes between two scans in one such frame stay right, but
/// the direction of "down" is that of the plane, not of gravity.
///
/// @throws Error (bad_input) with fewer than 100 finite points, if under a fifth of them lie on
/// one plane, or if that plane passes the sensor within 5 cm
LevelPose level_on_ground(const Cloud& scan, std::uint64_t seed = 1);

/// A pose found from known points.
struct PointPose {
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();  ///< a rigid motion
  std::vector<double> residuals;  ///< distance of every point from its place [m]
  double rms = 0.0;               ///< of the residuals [m]
};

/// The rigid motion (no scale) that takes points of a scan nearest to their known places, in least
/// squares (Kabsch 1976, Umeyama 1991).
///
/// @throws Error (bad_input) with fewer than three pairs, lists of different length, a coordinate
/// that is not finite, or points on one line
PointPose pose_of_points(const std::vector<Eigen::Vector3d>& in_scan,
                         const std::vector<Eigen::Vector3d>& in_site);

}  // namespace excavplan
