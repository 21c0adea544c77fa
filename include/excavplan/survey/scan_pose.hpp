// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <excavplan/survey/cloud.hpp>

/// @file
/// Pose of a sensor from its own scan: tilt and height from the ground plane, or all six degrees
/// of freedom from points of known position.

namespace excavplan {

/// A pose of which only tilt and height are determined.
struct LevelPose {
  /// Origin on the ground below the sensor, z up from the ground, x along the view direction (its z
  /// axis; within 5 deg of straight down, the upper side of its image, -y).
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
  std::vector<double> residuals;  ///< distance of every point from its known position [m]
  double rms = 0.0;               ///< of the residuals [m]
};

/// The rigid motion (no scale) from points of a scan to their known positions, by least squares
/// (Kabsch 1976, Umeyama 1991).
///
/// @throws Error (bad_input) with fewer than three pairs, lists of different length, a coordinate
/// that is not finite, or points on one line
PointPose pose_of_points(const std::vector<Eigen::Vector3d>& in_scan,
                         const std::vector<Eigen::Vector3d>& in_site);

}  // namespace excavplan
