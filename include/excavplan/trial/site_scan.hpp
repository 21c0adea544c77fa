// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <excavplan/machine/base_pose.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/trial/hidden_site.hpp>

/// @file
/// What the sensor of a site sees of its ground from a machine.

namespace excavplan {

/// How far and how densely the sensor of a site looks; all numbers are ours.
///
/// A scan is three looks while the upper structure swings, at 60 degrees to both sides and ahead of
/// a lidar on the cab, at 50 of a camera on the boom: one of 69 x 42 degrees sees too little from
/// one place. The looks are taken on the way to the dump and back, so that a scan costs no more
/// time for them.
struct SiteLooks {
  Eigen::Vector2d mount{0, 0};  ///< ahead of the swing axis and to its left [m]
  std::vector<double> swings;   ///< of the looks, to the left [rad]
  double sector = 0.0;          ///< of each look [rad]
  double nearest = 0.0;         ///< in plan from the sensor [m]
  double range = 0.0;           ///< farthest return [m]
  double spacing = 0.03;        ///< least between returns of one plane, on level ground [m]
  Eigen::Vector2d step{0, 0};   ///< between rays, across and, at least, along the tilt [rad]
};
/// Where it looks from, and how far.
SiteLooks looks_of(const SiteSensor& sensor);

/// Length along the ground over which the errors that neighbouring returns share are alike:
/// covariance exp(-d^2 / (2 length^2)); that of the first scans of the plain sites [m].
inline constexpr double pattern_length = 0.6;

/// Tops of what stands on the ground, in the cells of a surface; where nothing does the surface.
HeightMap with_obstacles(const HeightMap& surface, const std::vector<JobObstacle>& obstacles);

/// The scan of a machine that stands level. A ray that meets the surface gives a return; its range
/// has the sensor's noise and its pattern, its height the errors of registration: one draw in
/// height and two tilts about the machine. A cloud for each look, with the place of the sensor.
/// Same seed, same points.
/// @param seen  with_obstacles()
/// @throws Error (bad_input) if the surface is empty
Scan scan_site(const HeightMap& seen, const SiteSensor& sensor, const BasePose& base,
               std::uint64_t seed);

}  // namespace excavplan
