// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/trial/site_scan.hpp>

/// @file
/// Sensors as the plain sites have them, without noise.

namespace excavplan::test {

inline SiteSensor lidar() {
  SiteSensor sensor;
  sensor.name = "lidar";
  sensor.height = 3.0;
  sensor.tilt = 0.44;
  sensor.view = {6.2831853, 0.785};
  return sensor;
}

inline SiteSensor camera() {
  SiteSensor sensor = lidar();
  sensor.name = "camera";
  sensor.range_power = 2.0;
  sensor.on_boom = true;
  sensor.height = 3.2;
  sensor.tilt = 0.61;
  sensor.view = {1.204, 0.733};
  return sensor;
}

}  // namespace excavplan::test
