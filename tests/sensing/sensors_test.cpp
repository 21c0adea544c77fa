// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/sensors.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include <excavplan/sensing/depth_camera.hpp>

#include "support/errors.hpp"

namespace excavplan {
namespace {

TEST(Sensors, EachIsFoundByItsName) {
  std::set<std::string> names;
  for (const Sensor& sensor : sensors()) {
    EXPECT_TRUE(names.insert(sensor.name).second) << sensor.name;
    EXPECT_EQ(&sensor_of_word(sensor.name), &sensor);
    EXPECT_GT(sensor.noise, 0.0);
    EXPECT_GT(sensor.ray_angle, 0.0);
  }
  EXPECT_EQ(default_sensor().name, "d435i");
  EXPECT_EQ(test::error_of([] { sensor_of_word("eye"); }),
            "sensor is 'eye', must be d435i or lidar");
}

TEST(Sensors, CameraTakesAllErrorsOfItsSensorAndKeepsItsPlace) {
  const Sensor& sensor = sensor_of_word("d435i");
  DepthCamera placed;
  placed.position = {1.0, 2.0, 3.0};
  placed.frames = 30;
  const DepthCamera camera = with_errors_of(sensor, placed);
  EXPECT_EQ(camera.position, placed.position);
  EXPECT_EQ(camera.frames, 30);
  EXPECT_EQ(camera.width, 848);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.noise, sensor.noise);
  EXPECT_EQ(camera.pattern_noise, sensor.pattern);
  EXPECT_EQ(camera.pattern_length, sensor.pattern_rays);
  EXPECT_EQ(camera.disparity_step, sensor.disparity_step);
  EXPECT_EQ(camera.flying_pixels, sensor.flying_pixels);
  EXPECT_THROW(with_errors_of(sensor_of_word("lidar"), placed), Error);
}

TEST(Sensors, DepthsOfTheCameraComeInThirtySecondsOfAPixelOfDisparity) {
  // Data sheet of the D400 series: imagers 50 mm apart, disparities with five binary places.
  const Sensor& sensor = sensor_of_word("d435i");
  const double focal = 0.5 * sensor.width / std::tan(0.5 * sensor.view_across);
  EXPECT_NEAR(sensor.disparity_step, 1.0 / (32.0 * 0.050 * focal), 0.001 * sensor.disparity_step);
}

TEST(Sensors, LidarOfTheSimulationHasTheNoiseOfTheTable) {
  EXPECT_EQ(Lidar().range_noise, sensor_of_word("lidar").noise);
}

}  // namespace
}  // namespace excavplan
