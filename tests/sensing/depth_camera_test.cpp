// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/depth_camera.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

#include "support/errors.hpp"

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

/// A camera straight above flat ground whose pixels are 1 mm wide at the ground.
DepthCamera narrow_camera(double height) {
  DepthCamera camera = clean_camera();
  camera.position = {5.0, 0.0, height};
  camera.target = {5.0, 0.0, 0.0};
  camera.horizontal_view = 2.0 * std::atan(0.128 / height);
  return camera;
}

double rms_height(const std::vector<Eigen::Vector3d>& points) {
  double sum = 0.0;
  for (const Eigen::Vector3d& p : points) sum += p.z() * p.z();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

const HeightMap& level() {
  static const HeightMap map = flat_ground({2, -3, 8, 3}, 0.05);
  return map;
}

TEST(DepthCamera, FramesAverageTheNoiseButNotTheFixedPattern) {
  DepthCamera camera = narrow_camera(2.0);
  camera.noise = 0.002;
  camera.frames = 25;
  EXPECT_NEAR(rms_height(scan_surface(level(), camera, 3)), 0.002 * 4.0 / 5.0, 3e-5);
  camera.pattern_noise = 0.003;
  const double both = std::hypot(0.003 * 4.0, 0.002 * 4.0 / 5.0);
  EXPECT_NEAR(rms_height(scan_surface(level(), camera, 3)), both, 0.05 * both);
}

TEST(DepthCamera, PatternCovarianceFallsAsStated) {
  DepthCamera camera = narrow_camera(1.0);
  camera.pattern_noise = 0.004;
  camera.pattern_length = 4.0;
  const auto points = scan_surface(level(), camera, 11);
  ASSERT_EQ(points.size(), 256U * 144U);
  for (const std::size_t lag : {2U, 4U, 8U, 20U}) {
    double along = 0.0;
    double down = 0.0;
    for (std::size_t v = 0; v + lag < 144; ++v) {
      for (std::size_t u = 0; u + lag < 256; ++u) {
        const std::size_t at = 256 * v + u;
        along += points[at].z() * points[at + lag].z();
        down += points[at].z() * points[at + 256 * lag].z();
      }
    }
    const double count = static_cast<double>((144 - lag) * (256 - lag));
    const double expected = std::exp(-0.5 * std::pow(static_cast<double>(lag) / 4.0, 2));
    EXPECT_NEAR(along / count / 16e-6, expected, 0.12) << lag;
    EXPECT_NEAR(down / count / 16e-6, expected, 0.12) << lag;
  }
}

TEST(DepthCamera, DisparityComesInSteps) {
  DepthCamera camera = narrow_camera(2.0);
  camera.noise = 0.002;
  camera.disparity_step = 0.0014;
  std::map<long, int> seen;
  for (const Eigen::Vector3d& p : scan_surface(level(), camera, 3)) {
    const double disparity = 1.0 / (2.0 - p.z()) / 0.0014;
    EXPECT_NEAR(disparity, std::round(disparity), 1e-6);
    ++seen[std::lround(disparity)];
  }
  EXPECT_GT(seen.size(), 5U);
  EXPECT_LT(seen.size(), 25U);
}

TEST(DepthCamera, PixelsAtAnEdgeFlyBetweenBothSides) {
  HeightMap step = flat_ground({3.5, -1, 6.5, 1}, 0.005);  // the ramp is narrower than a pixel
  for (Eigen::Index col = 0; col < step.z.cols(); ++col) {
    if (step.x(col) > 5.0) step.z.col(col) = 0.5;
  }
  DepthCamera camera = narrow_camera(2.0);
  camera.horizontal_view = 1.0;
  const auto between = [&](double share) {
    camera.flying_pixels = share;
    int count = 0;
    for (const Eigen::Vector3d& p : scan_surface(step, camera, 2)) {
      count += p.z() > 0.02 && p.z() < 0.48 ? 1 : 0;
      EXPECT_GT(p.z(), -1e-9);
      EXPECT_LT(p.z(), 0.5 + 1e-9);
    }
    return count;
  };
  const int ramp = between(0.0);
  EXPECT_LT(ramp, 144);
  EXPECT_GT(between(1.0), ramp + 100);
}

TEST(DepthCamera, PixelsSeenInFewFramesAreLeftOut) {
  DepthCamera camera = narrow_camera(1.0);
  camera.dropouts = 0.6;
  camera.frames = 101;
  EXPECT_LT(static_cast<double>(scan_surface(level(), camera, 1).size()), 0.05 * 256 * 144);
  camera.dropouts = 0.4;
  EXPECT_GT(static_cast<double>(scan_surface(level(), camera, 1).size()), 0.95 * 256 * 144);
}

TEST(DepthCamera, ModelOfTheD435iHasTheStatedErrors) {
  // 0.05 px of noise over 30 frames and 0.06 px of pattern, at 2 m: 4 / 22.35 m per pixel.
  DepthCamera camera = with_errors_of(sensor_of_word("d435i"), narrow_camera(2.0));
  camera.frames = 30;
  camera.horizontal_view = 0.3;
  camera.target = {5.0, 0.01, 0.0};
  const double expected = 4.0 / 22.35 * std::hypot(0.06, 0.05 / std::sqrt(30.0));
  EXPECT_NEAR(rms_height(scan_surface(level(), camera, 5)), expected, 0.05 * expected);
}

TEST(DepthCamera, PixelsThatMeetNothingGiveNoPointsInStepsOfDisparityEither) {
  DepthCamera camera = with_errors_of(sensor_of_word("d435i"), {});
  const HeightMap small = flat_ground({-0.5, -0.5, 0.5, 0.5}, 0.05);
  const auto points = scan_surface(small, camera, 1);
  EXPECT_GT(points.size(), 10000U);
  for (const Eigen::Vector3d& p : points) ASSERT_LT(p.norm(), 1.5);
}

TEST(Lidar, SeesAPlaneWhereItIsWithTheNoiseOfItsRange) {
  HeightMap ground = flat_ground({-1, -6, 12, 6}, 0.05);
  for (Eigen::Index col = 0; col < ground.z.cols(); ++col) ground.z.col(col) = 0.1 * ground.x(col);
  Lidar lidar;
  lidar.azimuth = {-0.3, 0.3};
  lidar.elevation = {-0.9, -0.5};
  lidar.dropouts = 0.0;
  lidar.range_noise = 0.0;
  lidar.divergence = 0.0;
  const auto clean = scan_surface(ground, lidar, 1);
  EXPECT_EQ(clean.size(), 172U * 115U);
  for (const Eigen::Vector3d& p : clean) EXPECT_NEAR(p.z(), 0.1 * p.x(), 1e-9);
  lidar.range_noise = 0.02;
  const auto noisy = scan_surface(ground, lidar, 1);
  EXPECT_EQ(noisy, scan_surface(ground, lidar, 1));
  double sum = 0.0;
  for (std::size_t i = 0; i < noisy.size(); ++i) sum += (noisy[i] - clean[i]).squaredNorm();
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(noisy.size())), 0.02, 3e-4);
}

TEST(Lidar, WideBeamsMixTheReturnsOfAnEdge) {
  HeightMap step = flat_ground({0, -3, 8, 3}, 0.02);
  for (Eigen::Index col = 0; col < step.z.cols(); ++col) {
    if (step.x(col) > 4.0) step.z.col(col) = 0.3;
  }
  Lidar lidar;
  lidar.position = {4.0, 0.0, 4.0};
  lidar.azimuth = {-0.1, 0.1};
  lidar.elevation = {-1.65, -1.45};  // about straight down
  lidar.dropouts = 0.0;
  lidar.range_noise = 0.0;
  const auto between = [&](double divergence, double pulse_length) {
    lidar.divergence = divergence;
    lidar.pulse_length = pulse_length;
    int count = 0;
    for (const Eigen::Vector3d& p : scan_surface(step, lidar, 1)) {
      count += p.z() > 0.03 && p.z() < 0.27 ? 1 : 0;
    }
    return count;
  };
  const int sharp = between(0.0, 0.6);
  EXPECT_GT(between(0.03, 0.6), 3 * sharp + 50);
  // A short pulse separates both: the first return counts.
  EXPECT_LT(between(0.03, 0.05), between(0.03, 0.6) / 2);
}

TEST(Lidar, MessageNamesTheRule) {
  Lidar lidar;
  lidar.azimuth = {0.5, -0.5};
  EXPECT_EQ(test::error_of([&] { scan_surface(level(), lidar, 1); }),
            "lidar: width of a window is -1, must be >= 0 rad");
  lidar = {};
  lidar.angle_step = {1e-6, 1e-6};
  EXPECT_THROW(scan_surface(level(), lidar, 1), Error);
}

TEST(DepthCamera, MessageNamesTheRule) {
  DepthCamera camera = clean_camera();
  camera.dropouts = 1.5;
  EXPECT_EQ(test::error_of([&] {
              scan_surface(flat_ground({2, -3, 8, 3}, 0.05), camera, 1);
            }),
            "depth camera: dropouts is 1.5, must be in 0 .. 1");
  camera = clean_camera();
  camera.frames = 0;
  EXPECT_THROW(scan_surface(level(), camera, 1), Error);
  camera = clean_camera();
  camera.target = camera.position;
  EXPECT_THROW(scan_surface(flat_ground({2, -3, 8, 3}, 0.05), camera, 1), Error);
}

}  // namespace
}  // namespace excavplan
