// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/depth_camera.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/error.hpp>

namespace excavplan {
namespace {

DepthCamera clean_camera() {
  DepthCamera camera = camera_above({5.0, 0.0}, 0.0);
  camera.noise = 0.0;
  camera.dropouts = 0.0;
  return camera;
}

TEST(DepthCamera, SeesAPlaneWhereItIs) {
  HeightMap ground = flat_ground({2, -3, 8, 3}, 0.05);
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) ground.z.col(col) = 0.1 * ground.x(col);
  const auto points = scan_surface(ground, clean_camera(), 1);
  EXPECT_EQ(points.size(), 256U * 144U);
  for (const Eigen::Vector3d& p : points) EXPECT_NEAR(p.z(), 0.1 * p.x(), 1e-9);
}

TEST(DepthCamera, FieldOfViewIsThatOfTheSensor) {
  const auto points = scan_surface(flat_ground({0, -4, 10, 4}, 0.05), clean_camera(), 1);
  double x_max = 0.0;
  for (const Eigen::Vector3d& p : points) x_max = std::max(x_max, p.x());
  // Half of 87 deg from 2.8 m, the last pixel's centre half a pixel inside.
  EXPECT_NEAR(x_max - 5.0, std::hypot(2.8, 0.3) * std::tan(1.5184 / 2) * 255 / 256, 0.35);
}

TEST(DepthCamera, SeesNothingBehindAWall) {
  HeightMap ground = flat_ground({2, -3, 8, 3}, 0.05);
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
    if (ground.x(col) > 6.0 && ground.x(col) < 6.2) ground.z.col(col) = 1.0;
  }
  // The ray over the wall's far edge, 1.2 m off and 1.8 m below, meets the ground 1.87 m off.
  int behind = 0;
  for (const Eigen::Vector3d& p : scan_surface(ground, clean_camera(), 1)) {
    behind += p.x() > 6.27 && p.x() < 6.80 && p.z() < 0.05 ? 1 : 0;
  }
  EXPECT_EQ(behind, 0);
}

TEST(DepthCamera, UnknownGroundIsNotSeen) {
  HeightMap ground = flat_ground({2, -3, 8, 3}, 0.05);
  ground.z.block(50, 50, 20, 20) = std::nan("");
  for (const Eigen::Vector3d& p : scan_surface(ground, clean_camera(), 1)) {
    EXPECT_FALSE(p.x() > 4.5 && p.x() < 5.5 && p.y() > -0.5 && p.y() < 0.5);
  }
}

TEST(DepthCamera, NoiseGrowsWithTheSquareOfTheRange) {
  const auto spread = [](double height) {
    DepthCamera camera = clean_camera();
    camera.position = {5.0, 0.0, height};
    camera.target = {5.0, 0.0, 0.0};
    camera.noise = 0.0027;
    camera.horizontal_view = 0.2;
    double sum = 0.0;
    const auto points = scan_surface(flat_ground({2, -3, 8, 3}, 0.05), camera, 3);
    for (const Eigen::Vector3d& p : points) sum += p.z() * p.z();
    return std::sqrt(sum / static_cast<double>(points.size()));
  };
  EXPECT_NEAR(spread(1.0), 0.0027, 0.0001);
  EXPECT_NEAR(spread(3.0) / spread(1.0), 9.0, 0.3);
}

TEST(DepthCamera, SameSeedSamePointsAndDropoutsAreCounted) {
  DepthCamera camera = clean_camera();
  camera.noise = 0.0027;
  camera.dropouts = 0.3;
  const HeightMap ground = flat_ground({2, -3, 8, 3}, 0.05);
  const auto one = scan_surface(ground, camera, 5);
  EXPECT_EQ(one, scan_surface(ground, camera, 5));
  EXPECT_NE(one, scan_surface(ground, camera, 6));
  EXPECT_NEAR(static_cast<double>(one.size()), 0.7 * 256 * 144, 500.0);
}

TEST(DepthCamera, MessageNamesTheRule) {
  DepthCamera camera = clean_camera();
  camera.dropouts = 1.5;
  try {
    scan_surface(flat_ground({2, -3, 8, 3}, 0.05), camera, 1);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "depth camera: dropouts must be in 0 .. 1, got 1.500000");
  }
  camera = clean_camera();
  camera.target = camera.position;
  EXPECT_THROW(scan_surface(flat_ground({2, -3, 8, 3}, 0.05), camera, 1), Error);
}

}  // namespace
}  // namespace excavplan
