// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/sensor_look.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace excavplan {
namespace {

TEST(SensorLook, AScanTellsWhereItsSensorIsAndWhatItSees) {
  const BasePose base = {3.0, -2.0, 0.4, 0.7};
  const Eigen::Rotation2Dd turn(base.heading);
  auto cloud = std::make_shared<Cloud>();
  const Eigen::Vector2d eye = Eigen::Vector2d(base.x, base.y) + turn * Eigen::Vector2d(0.6, 0.7);
  cloud->sensor_origin = Eigen::Vector3d(eye.x(), eye.y(), base.z + 3.0);
  for (double azimuth = -1.2; azimuth <= 0.2; azimuth += 0.01) {
    for (double range = 4.0; range <= 10.0; range += 0.1) {
      const double at = base.heading + azimuth;
      cloud->points.emplace_back(eye.x() + range * std::cos(at), eye.y() + range * std::sin(at),
                                 base.z);
    }
  }
  Scan scan;
  scan.clouds = {cloud, std::make_shared<Cloud>()};
  const auto looks = looks_of(scan, base);
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_LT((looks[0].from - Eigen::Vector3d(0.6, 0.7, 3.0)).norm(), 1e-9);
  EXPECT_NEAR(looks[0].azimuth, -0.5, 0.02);
  EXPECT_NEAR(looks[0].half_sector, 0.7, 0.03);
  EXPECT_NEAR(looks[0].range, 10.0, 0.2);
  EXPECT_NEAR(looks[0].steepest, std::atan2(3.0, 4.0), 0.02);
}

TEST(SensorLook, TheEdgeOfATrenchHidesTheFootOfItsWall) {
  HeightMap ground;
  ground.cell_size = 0.05;
  ground.z = Eigen::ArrayXXd::Zero(40, 200);
  ground.z.rightCols(100).setConstant(-0.5);      // from x = 5 on
  const SensorLook look = usual_looks().front();  // 3 m over the ground, 0.6 m ahead
  const BasePose base = {1.4, 1.0, 0.0, 0.0};
  // Its ray over the edge meets the floor 0.5 / 3 of its way to the edge behind that.
  const double foot = 5.0 + 0.5 * (5.0 - 2.0) / 3.0;
  EXPECT_FALSE(sees(look, base, ground, {foot - 0.1, 1.0, -0.5}));
  EXPECT_TRUE(sees(look, base, ground, {foot + 0.1, 1.0, -0.5}));
  EXPECT_TRUE(sees(look, base, ground, {4.9, 1.0, 0.0}));
  EXPECT_FALSE(sees(look, base, ground, {2.5, 1.0, 0.0})) << "below its view";
}

}  // namespace
}  // namespace excavplan
