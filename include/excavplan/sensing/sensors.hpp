// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// @file
/// The error models of sensors: scans are simulated and surveys are planned with the same figures
/// (`docs/methods.md#sensors`).

namespace excavplan {

/// Errors of a sensor that sends rays at equal angles. What has no unit is a count or a share.
struct Sensor {
  std::string name;           ///< that chooses it on the command line: "d435i"
  double noise = 0.0;         ///< sd at 1 m of a range, independent from frame to frame [m]
  double pattern = 0.0;       ///< sd at 1 m of the part common to all frames of a scan [m]
  double pattern_rays = 0.0;  ///< its length in rays: covariance exp(-n^2 / (2 rays^2))
  double range_power = 0.0;   ///< both grow with range to this power: 2 for stereo, 0 for lidar
  double ray_angle = 0.0;     ///< between neighbouring rays [rad]
  double view_across = 0.0;   ///< field of view [rad]
  double view_along = 0.0;    ///< in the direction in which it is tilted [rad]

  // Of a stereo camera only.
  int width = 0;                ///< of its image [pixel]
  int height = 0;               ///< [pixel]
  double disparity_step = 0.0;  ///< 1 / depth comes in multiples of this [1/m]; 0: in none
  double flying_pixels = 0.0;   ///< share of the pixels at a step of depth that lie between both
};

/// All sensors with a model; the first is the default. Their figures and the sources are in
/// src/sensing/sensors.cpp.
const std::vector<Sensor>& sensors();
/// The first of them.
inline const Sensor& default_sensor() { return sensors().front(); }

/// The sensor of this name. @throws Error (bad_input) naming the sensors there are
const Sensor& sensor_of_word(const std::string& word);

}  // namespace excavplan
