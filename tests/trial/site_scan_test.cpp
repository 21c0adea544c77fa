// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/site_scan.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/statistics.hpp"
#include "trial/site_sensors.hpp"

namespace excavplan::test {
namespace {

HeightMap level() { return flat_ground({-15, -15, 15, 15}, 0.025); }

std::vector<Eigen::Vector3d> points_of(const Scan& scan) {
  std::vector<Eigen::Vector3d> all;
  for (const auto& cloud : scan.clouds) {
    all.insert(all.end(), cloud->points.begin(), cloud->points.end());
  }
  return all;
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / n - sum / n * sum / n);
}

/// Errors of the ranges of a scan of level ground, over range to a power.
std::vector<double> range_errors(const SiteSensor& sensor, std::uint64_t seed) {
  std::vector<double> all;
  for (const auto& cloud : scan_site(level(), sensor, {}, seed).clouds) {
    for (const Eigen::Vector3d& point : cloud->points) {
      const Eigen::Vector3d ray = point - *cloud->sensor_origin;
      const double measured = ray.norm();
      const double range = -cloud->sensor_origin->z() / (ray.z() / measured);
      all.push_back((measured - range) / std::pow(range, sensor.range_power));
    }
  }
  return all;
}

TEST(SiteScan, LevelGroundIsSeenWhereItIs) {
  for (const SiteSensor& sensor : {lidar(), camera()}) {
    const auto points = points_of(scan_site(level(), sensor, {1.0, 2.0, 0.0, 0.7}, 1));
    EXPECT_GT(points.size(), 30000U) << sensor.name;
    EXPECT_LE(points.size(), 200000U) << sensor.name;
    for (const Eigen::Vector3d& point : points) ASSERT_NEAR(point.z(), 0.0, 1e-9);
  }
}

TEST(SiteScan, EveryCellWithinReachHasAReturn) {
  const HeightMap cells = flat_ground({3.8, -1.5, 7.0, 1.5}, 0.05);
  for (const SiteSensor& sensor : {lidar(), camera()}) {
    Eigen::ArrayXXd count = 0.0 * cells.z;
    for (const Eigen::Vector3d& point : points_of(scan_site(level(), sensor, {}, 1))) {
      if (!cells.extent().contains(point.x(), point.y())) continue;
      count(static_cast<Eigen::Index>((point.y() + 1.5) / 0.05),
            static_cast<Eigen::Index>((point.x() - 3.8) / 0.05)) += 1.0;
    }
    EXPECT_GT((count > 0.0).cast<double>().mean(), 0.98) << sensor.name;
  }
}

TEST(SiteScan, RangesHaveTheStatedNoise) {
  for (SiteSensor sensor : {lidar(), camera()}) {
    sensor.noise = 0.003;
    const std::vector<double> errors = range_errors(sensor, 3);
    EXPECT_NEAR(deviation(errors), 0.003, 0.00005) << sensor.name;
    double neighbours = 0.0;
    for (std::size_t i = 1; i < errors.size(); ++i) neighbours += errors[i] * errors[i - 1];
    EXPECT_LT(std::abs(neighbours) / static_cast<double>(errors.size()), 0.02 * 9e-6);
  }
}

TEST(SiteScan, ThePatternHasTheStatedDeviationAndIsSharedByNeighbours) {
  for (SiteSensor sensor : {lidar(), camera()}) {
    sensor.pattern = 0.004;
    double variance = 0.0;
    constexpr int scans = 30;
    for (int seed = 0; seed < scans; ++seed) {
      const std::vector<double> errors = range_errors(sensor, 100U + static_cast<unsigned>(seed));
      double squares = 0.0, neighbours = 0.0;
      for (std::size_t i = 1; i < errors.size(); ++i) {
        squares += errors[i] * errors[i];
        neighbours += errors[i] * errors[i - 1];
      }
      EXPECT_GT(neighbours, 0.95 * squares);
      variance += squares / static_cast<double>(errors.size()) / scans;
    }
    EXPECT_NEAR(std::sqrt(variance), 0.004, 0.0004) << sensor.name;
  }
}

TEST(SiteScan, RegistrationErrsByHeightAndTilt) {
  SiteSensor sensor = lidar();
  sensor.height_sd = 0.01;
  sensor.tilt_sd = 0.002;
  std::vector<double> heights, tilts;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const auto points = points_of(scan_site(level(), sensor, {}, seed));
    for (std::size_t i = 0; i < points.size(); i += 50) {
      const Eigen::Vector3d row(1.0, points[i].x(), points[i].y());
      normal += row * row.transpose();
      right += points[i].z() * row;
    }
    const Eigen::Vector3d plane = normal.inverse() * right;
    heights.push_back(plane.x());
    tilts.push_back(plane.y());
    tilts.push_back(plane.z());
  }
  EXPECT_NEAR(deviation(heights), 0.01, 0.003);
  EXPECT_NEAR(deviation(tilts), 0.002, 0.0005);
}

TEST(SiteScan, WhatIsBehindAnObstacleIsNotSeen) {
  const JobObstacle wall = {"wall", {{5.0, -1.0}, {5.3, -1.0}, {5.3, 1.0}, {5.0, 1.0}}, 2.0};
  const HeightMap seen = with_obstacles(level(), {wall});
  bool on_top = false;
  for (const Eigen::Vector3d& point : points_of(scan_site(seen, lidar(), {}, 1))) {
    if (std::abs(point.y()) > 0.3) continue;
    on_top = on_top || point.z() > 1.0;
    EXPECT_FALSE(point.x() > 5.5 && point.x() < 8.0 && point.z() < 0.5) << point.transpose();
  }
  EXPECT_TRUE(on_top);
}

TEST(SiteScan, TheFloorBehindARimIsNotSeen) {
  HeightMap pit = level();
  for (Eigen::Index col = 0; col < pit.z.cols(); ++col) {
    if (pit.x(col) > 5.0 && pit.x(col) < 8.0) pit.z.col(col) = -1.0;
  }
  double nearest = 100.0;
  for (const Eigen::Vector3d& point : points_of(scan_site(pit, lidar(), {}, 1))) {
    if (std::abs(point.y() - 0.7) < 0.2 && point.z() < -0.9) nearest = std::min(nearest, point.x());
  }
  // The ray over the rim falls 3 m over 4.4 m.
  EXPECT_NEAR(nearest, 5.0 + 4.4 / 3.0, 0.1);
}

TEST(SiteScan, SameSeedSamePoints) {
  SiteSensor sensor = camera();
  sensor.noise = 0.001;
  sensor.pattern = 0.0012;
  sensor.height_sd = 0.006;
  const auto first = points_of(scan_site(level(), sensor, {}, 9));
  EXPECT_EQ(first, points_of(scan_site(level(), sensor, {}, 9)));
  EXPECT_NE(first, points_of(scan_site(level(), sensor, {}, 10)));
}

}  // namespace
}  // namespace excavplan::test
