// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// Pose of a sensor from its own scan: tilt and height from the ground plane, or all six degrees
/// of freedom from points of known position.

namespace excavplan {

/// A pose of which only tilt and height are determined.
struct LevelPose {
  /// Origin on the ground below the sensor, z up from the ground, x forward: of a camera, whose z
  /// axis points forward or down, along that axis (within 5 deg of straight down, towards the upper
  /// side of its image, -y); of a sensor whose z axis is within 45 deg of up, as a lidar's, along
  /// its x axis.
  Eigen::Matrix4d site_from_scan = Eigen::Matrix4d::Identity();
  double height = 0.0;        ///< of the sensor above the ground [m]
  double tilt = 0.0;          ///< between the sensor's z axis and straight down [rad]
  double residual_sd = 0.0;   ///< of the ground about its plane [m]
  double ground_share = 0.0;  ///< of the finite points, on the plane [-]
};

/// Levels a scan by its largest plane, which must be the ground: RANSAC within 1 % of the median
/// range, then least squares over the points within 2.5 robust sd until they stay the same. Points
/// count with 1 / range^4, as stereo errs. The sensor stood at Cloud::sensor_origin, or else at the
/// origin. Where it is not told and the plane passes the origin within 5 cm, as of apps that lay
/// the origin on the ground, all points count alike, up is the axis z or y of the scan (within 45
/// deg) and x shows along its x or -z axis. Same seed, same pose.
///
/// Ground that slopes is levelled too: volumes between two scans in one such frame stay right, but
/// the direction of "down" is that of the plane, not of gravity.
///
/// @throws Error (bad_input) with fewer than 100 finite points, if under a tenth of them lie on
/// one plane, or if that plane passes the sensor within 5 cm, and is no ground at the origin
LevelPose level_on_ground(const Cloud& scan, std::uint64_t seed = 1);

/// The same of a scan of any size, from a random choice of 32768 to 65536 of its points that is the
/// same every time; the pose follows Scan::site_from_scan. The sensor stood where the scan or its
/// files say, if they agree, or else at the origin of the files.
/// @throws Error (bad_file) as read_cloud() and as above, naming the scan
LevelPose level_on_ground(const Scan& scan, std::uint64_t seed = 1);

/// Points of a scan whose places in the site are known, pair by pair.
struct KnownPoints {
  std::vector<Eigen::Vector3d> in_scan;  ///< [m]
  std::vector<Eigen::Vector3d> in_site;  ///< the same points [m]
};

/// Reads them from a CSV file with the columns x_m, y_m, z_m of the site and scan_x_m, scan_y_m,
/// scan_z_m (or camera_x_m, camera_y_m, camera_z_m) of the scan.
/// @throws Error (bad_file) naming file, line or column and rule
KnownPoints read_known_points(const std::string& path);

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
/// that is not finite, points on one line, or points that stay over a tenth of their distance from
/// their middle away from their places (rms): of other units, exchanged, mirrored
PointPose pose_of_points(const std::vector<Eigen::Vector3d>& in_scan,
                         const std::vector<Eigen::Vector3d>& in_site);

}  // namespace excavplan
