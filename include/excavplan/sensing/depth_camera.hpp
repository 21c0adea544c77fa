// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/sensing/sensors.hpp>

/// @file
/// Scans of a surface by a depth camera or a lidar, errors included
/// (`docs/methods.md#sensors`).

namespace excavplan {

/// A depth camera in the site frame.
///
/// By default depth has white noise and dropouts only; with_errors_of() sets all errors of a stereo
/// camera.
struct DepthCamera {
  Eigen::Vector3d position = {0.0, 0.0, 2.5};  ///< [m]
  Eigen::Vector3d target = {0.0, 0.0, 0.0};    ///< point on the optical axis [m]
  int width = 256;                             ///< pixels; the image's x axis is level
  int height = 144;                            ///< pixels
  double horizontal_view = 1.5184;             ///< field of view [rad]; ours: 87 deg
  double noise = 0.0027;   ///< sd of the depth at 1 m, grows with range squared [m]; ours
  double dropouts = 0.02;  ///< share of pixels without depth [-]
  double max_range = 6.0;  ///< [m]; ours
  int frames = 1;          ///< averaged; noise and dropouts differ from frame to frame
  /// sd at 1 m of the part common to all frames of a scan, grows with range squared [m].
  double pattern_noise = 0.0;
  double pattern_length = 3.0;  ///< its covariance falls as exp(-d^2 / (2 length^2)) [pixel]
  double disparity_step = 0.0;  ///< 1 / depth comes in multiples of this [1/m]; 0: in none
  double flying_pixels = 0.0;   ///< share of the pixels at a step of depth that lie between both
};

/// A camera that faces down on a patch of ground from 2.8 m, a little from the side, its long image
/// axis along x; ours: near enough for 1 % of bulking factor, high enough to see the whole dig.
DepthCamera camera_above(const Eigen::Vector2d& ground_point, double ground_z);

/// The same camera with the pixels and the errors of a sensor of the table, which must be a camera;
/// its place, field of view, range, dropouts and frames stay.
/// @throws Error (bad_input) if the sensor has no image
DepthCamera with_errors_of(const Sensor& sensor, DepthCamera camera);

/// The points that the camera sees of a surface, in the site frame [m].
///
/// Casts one ray per pixel at the bilinear surface of `surface`; what is hidden from the camera is
/// not seen, nor are unknown cells. A pixel without depth in more than half of the frames is left
/// out. Same seed, same points.
///
/// @throws Error (bad_input) if the camera looks straight up or down its own axis, a count is not
///         positive, or an option is out of range
std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const DepthCamera& camera,
                                          std::uint64_t seed);

/// A lidar that stands upright and sweeps a window of directions. The defaults are ours, of the
/// size that data sheets of construction scanners state.
struct Lidar {
  Eigen::Vector3d position = {0.0, 0.0, 3.0};          ///< [m]
  Eigen::Vector2d azimuth = {-0.8, 0.8};               ///< first and last, from the x axis [rad]
  Eigen::Vector2d elevation = {-1.2, -0.2};            ///< first and last, up is positive [rad]
  Eigen::Vector2d angle_step = {0.0035, 0.0035};       ///< of azimuth and elevation [rad]
  double range_noise = sensor_of_word("lidar").noise;  ///< sd of one range, at any distance [m]
  double divergence = 0.003;                           ///< full angle of the beam [rad]
  double pulse_length = 0.6;  ///< returns nearer to each other than this mix into one [m]
  double dropouts = 0.02;     ///< share of beams without a return [-]
  double max_range = 40.0;    ///< [m]
};

/// The points that the lidar sees of a surface, in the site frame [m].
///
/// A beam returns the mean range over its footprint (seven rays, exact for a curved surface of
/// third degree); where the footprint lies across an edge, the first return mixes with what follows
/// within the pulse. Same seed, same points.
///
/// @throws Error (bad_input) if an option is out of range, or there are over 100 million beams
std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const Lidar& lidar,
                                          std::uint64_t seed);

}  // namespace excavplan
