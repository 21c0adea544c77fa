// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// A depth camera in the site frame.
struct DepthCamera {
  Eigen::Vector3d position = {0.0, 0.0, 2.5};  ///< [m]
  Eigen::Vector3d target = {0.0, 0.0, 0.0};    ///< point on the optical axis [m]
  int width = 256;                             ///< pixels; the image's x axis is level
  int height = 144;
  double horizontal_view = 1.5184;  ///< field of view [rad]; 87 deg: D435i (docs/methods.md#sensors)
  double noise =
      0.0027;  ///< sd of the depth at 1 m, grows with range squared [m]; 0.06 px of a D435i
  double dropouts = 0.02;  ///< share of pixels without depth [-]
  double max_range = 6.0;  ///< [m]; ours
};

/// A camera that looks down on a patch of ground from 2.8 m, a little from the side, its long image
/// axis along x; ours: near enough for 1 % of bulking factor, high enough to see a dig whole.
DepthCamera camera_above(const Eigen::Vector2d& ground_point, double ground_z);

/// The points that the camera sees of a surface, in the site frame [m].
///
/// Casts one ray per pixel at the bilinear surface of `surface`; what is hidden from the camera is
/// not seen, nor are unknown cells. Same seed, same points.
///
/// @throws Error (bad_input) if the camera looks straight up or down its own axis, a count is not
///         positive, or an option is out of range
std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const DepthCamera& camera,
                                          std::uint64_t seed);

}  // namespace excavplan
