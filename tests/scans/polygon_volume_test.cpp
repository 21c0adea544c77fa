// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/polygon_volume.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/errors.hpp"

/// @file
/// Volumes of cones in closed form, on sloping ground, from noisy points.

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double radius = 1.0, height = 0.6;
const double truth = pi * radius * radius * height / 3.0;
const std::vector<Vector2d> polygon = {{3.6, -1.4}, {6.4, -1.4}, {6.4, 1.4}, {3.6, 1.4}};

struct Ground {
  double cone = height;  ///< < 0: a hole
  double slope = 0.1;
  double bend = 0.0;  ///< of the ground along x [1/m]
  double far = 0.0;   ///< of all from the origin [m]
};

Scan cone(const Ground& ground, std::uint64_t seed, double noise = 0.01) {
  Random random(17, seed);
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 30000; ++i) {
    const double x = random.uniform(2.5, 7.5), y = random.uniform(-2.5, 2.5);
    const double heap = ground.cone * std::max(0.0, 1.0 - std::hypot(x - 5.0, y) / radius);
    const double even = ground.slope * x + 0.5 * ground.bend * std::pow(x - 5.0, 2);
    cloud->points.emplace_back(x + ground.far, y + ground.far,
                               even + heap + noise * random.normal());
  }
  cloud->width = cloud->points.size();
  Scan scan;
  scan.clouds = {cloud};
  return scan;
}

TEST(PolygonVolume, IsThatOfAConeWithinItsDeviation) {
  for (const double sign : {1.0, -1.0}) {
    double squares = 0.0;
    constexpr int surveys = 12;
    for (std::uint64_t seed = 0; seed < surveys; ++seed) {
      const PolygonVolume found = volume_over(cone({sign * height}, seed), polygon);
      const Measured& heap = sign > 0.0 ? found.above : found.below;
      const Measured& other = sign > 0.0 ? found.below : found.above;
      EXPECT_NEAR(heap.value, truth, 0.01 * truth);
      EXPECT_GT(heap.sd, 0.0);
      EXPECT_LT(heap.sd, 0.02 * truth);
      EXPECT_LT(other.value, 3.0 * other.sd);
      EXPECT_TRUE(found.warnings.empty());
      squares += std::pow((heap.value - truth) / heap.sd, 2) / surveys;
    }
    EXPECT_LT(std::sqrt(squares), 1.6) << "the deviation holds";
    EXPECT_GT(std::sqrt(squares), 0.15);
  }
  EXPECT_NEAR(volume_over(cone({}, 1), polygon).area, 2.8 * 2.8, 1e-12);
}

TEST(PolygonVolume, NoiseOfTheRimOfEvenGroundIsNoRelief) {
  constexpr int surveys = 30;
  double sd = 0.0, squares = 0.0;
  for (std::uint64_t seed = 0; seed < surveys; ++seed) {
    const PolygonVolume found = volume_over(cone({0.0}, seed, 0.03), polygon);
    sd += found.above.sd / surveys;
    squares += std::pow(found.above.value, 2) / surveys;
  }
  EXPECT_NEAR(sd / std::sqrt(squares), 1.0, 0.3);
}

TEST(PolygonVolume, TheRimOnUnevenGroundWidensTheDeviation) {
  const PolygonVolume even = volume_over(cone({}, 1), polygon);
  const PolygonVolume bent = volume_over(cone({height, 0.1, 0.15}, 1), polygon);
  EXPECT_GT(bent.above.sd, 1.5 * even.above.sd);
  EXPECT_NEAR(bent.above.value, truth, 3.0 * bent.above.sd);
}

TEST(PolygonVolume, IsTheSameInEitherSenseAndFarFromTheOrigin) {
  std::vector<Vector2d> other = polygon;
  std::reverse(other.begin(), other.end());
  const PolygonVolume found = volume_over(cone({}, 2), polygon);
  EXPECT_NEAR(volume_over(cone({}, 2), other).above.value, found.above.value, 1e-3);
  constexpr double far = 4.5e6;
  for (Vector2d& corner : other) corner += Vector2d::Constant(far);
  EXPECT_NEAR(volume_over(cone({height, 0.1, 0.0, far}, 2), other).above.value - 0.0,
              found.above.value, 2e-3);
}

TEST(PolygonVolume, WhatIsNotSeenIsToldAndEndsTrust) {
  const auto without = [](double x_from, double x_to) {
    Scan scan = cone({}, 3);
    auto part = std::make_shared<Cloud>();
    for (const Eigen::Vector3d& p : scan.clouds.front()->points) {
      if (p.x() < x_from || p.x() > x_to) part->points.push_back(p);
    }
    part->width = part->points.size();
    scan.clouds = {part};
    return scan;
  };
  const PolygonVolume part = volume_over(without(4.8, 5.1), polygon);
  ASSERT_EQ(part.warnings.size(), 1U);
  EXPECT_EQ(part.warnings[0].code, WarningCode::zone_partly_unseen);
  EXPECT_TRUE(part.warnings[0].ends_trust);
  EXPECT_GT(part.above.sd, 3.0 * volume_over(cone({}, 3), polygon).above.sd);
  const auto error =
      test::error_of([&] { volume_over(without(3.0, 7.0), polygon); }, ErrorKind::bad_file);
  EXPECT_NE(error.find("same frame"), std::string::npos) << error;
}

TEST(PolygonVolume, RefusesWhatIsNoPolygon) {
  EXPECT_EQ(test::error_of([] {
              volume_over(cone({}, 1), {{0, 0}, {1, 0}});
            }),
            "volume: the polygon needs at least three corners, all finite");
  EXPECT_EQ(test::error_of([] {
              volume_over(cone({}, 1), {{0, 0}, {1, 0}, {2, 0}});
            }),
            "volume: area of the polygon is 0, must be above 0 m^2");
}

}  // namespace
}  // namespace excavplan
