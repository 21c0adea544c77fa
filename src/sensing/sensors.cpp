// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/sensors.hpp>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"

namespace excavplan {
namespace {

/// Intel RealSense D435i at 848 x 480 pixels. Field of view and f B (focal length times baseline):
/// data sheet. A depth errs by the error of its disparity times z^2 / (f B); 0.05 px of noise and
/// 0.06 px of pattern, 3 px wide, and half of all pixels at edges flying: docs/methods.md#sensors.
Sensor d435i() {
  constexpr double focal = 446.8;                 // 848 px over 87 deg [px]
  constexpr double focal_times_baseline = 22.35;  // [px m]
  Sensor sensor;
  sensor.name = "d435i";
  sensor.noise = 0.05 / focal_times_baseline;
  sensor.pattern = 0.06 / focal_times_baseline;
  sensor.pattern_rays = 3.0;
  sensor.range_power = 2.0;
  sensor.ray_angle = 1.0 / focal;
  sensor.view_across = 87.0 * degree;
  sensor.view_along = 58.0 * degree;
  sensor.width = 848;
  sensor.height = 480;
  sensor.disparity_step = 1.0 / 32.0 / focal_times_baseline;
  sensor.flying_pixels = 0.5;
  return sensor;
}

/// A scanning lidar of 0.2 degrees, of the size that data sheets of construction scanners state;
/// the 3 mm that 5 neighbouring rays share are ours.
Sensor lidar() {
  Sensor sensor;
  sensor.name = "lidar";
  sensor.noise = 0.020;
  sensor.pattern = 0.003;
  sensor.pattern_rays = 5.0;
  sensor.ray_angle = 0.2 * degree;
  sensor.view_across = 70.0 * degree;
  sensor.view_along = 70.0 * degree;
  return sensor;
}

}  // namespace

const std::vector<Sensor>& sensors() {
  static const std::vector<Sensor> list = {d435i(), lidar()};
  return list;
}

const Sensor& sensor_of_word(const std::string& word) {
  std::string words;
  for (const Sensor& sensor : sensors()) {
    if (sensor.name == word) return sensor;
    words += (words.empty() ? "" : " or ") + sensor.name;
  }
  throw Error(ErrorKind::bad_input, "sensor is '" + word + "', must be " + words);
}

}  // namespace excavplan
