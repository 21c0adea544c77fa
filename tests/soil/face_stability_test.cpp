// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>
#include <excavplan/soil/face_stability.hpp>

#include "base/angles.hpp"

namespace excavplan::test {
namespace {

constexpr double weight = 18000.0;  // [N/m^3]

SoilState soil(double cohesion, double friction) {
  SoilState state;
  state.unit_weight = weight;
  state.cohesion = cohesion;
  state.friction_angle = friction;
  return state;
}

SoilFace face(double height, double angle) {
  SoilFace made;
  made.height = height;
  made.run = angle < 0.5 * pi ? height / std::tan(angle) : 0.0;
  return made;
}

/// c / (gamma H) at which faces just stand, by the friction circle: Taylor, Stability of Earth
/// Slopes, 1937, recalled; for friction angles of 0, 5 .. 25 degrees.
struct StabilityNumbers {
  double angle;  ///< of the face [deg]
  std::array<double, 6> at_friction;
};
const std::array<StabilityNumbers, 5> taylor = {
    {{90.0, {0.261, 0.239, 0.218, 0.199, 0.182, 0.166}},
     {75.0, {0.219, 0.195, 0.173, 0.152, 0.134, 0.117}},
     {60.0, {0.191, 0.162, 0.138, 0.116, 0.097, 0.079}},
     {45.0, {0.170, 0.136, 0.108, 0.083, 0.062, 0.044}},
     {30.0, {0.156, 0.110, 0.075, 0.046, 0.025, 0.009}}}};

TEST(FaceStability, JustStandsAtTaylorsStabilityNumbers) {
  constexpr double height = 3.0;
  for (const StabilityNumbers& each : taylor) {
    for (std::size_t i = 0; i < each.at_friction.size(); ++i) {
      const SoilState at_limit =
          soil(each.at_friction[i] * weight * height, 5.0 * degree * static_cast<double>(i));
      const double factor = factor_of_safety(at_limit, face(height, each.angle * degree), 0.0);
      EXPECT_GT(factor, 0.93) << each.angle << " deg, friction " << 5 * i;
      EXPECT_LT(factor, 1.015) << each.angle << " deg, friction " << 5 * i;
    }
  }
}

TEST(FaceStability, ACrackLowersAnUprightWallToTerzaghisHeight) {
  const SoilState loam = soil(8000.0, 30.0 * degree);
  const double culmann = critical_height(loam);
  const double uncracked = factor_of_safety(loam, face(culmann, 0.5 * pi), 0.0);
  EXPECT_LT(uncracked, 1.0) << "a circle is worse than Culmann's plane";
  EXPECT_GT(uncracked, 0.88);
  EXPECT_NEAR(factor_of_safety(loam, face(2.0 / 3.0 * culmann, 0.5 * pi)), 1.0, 0.03);
}

TEST(FaceStability, GrainsStandUpToTheirFrictionAngle) {
  const SoilState gravel = soil(0.0, 40.0 * degree);
  for (const double angle : {20.0, 30.0, 40.0, 60.0}) {
    EXPECT_NEAR(factor_of_safety(gravel, face(1.0, angle * degree)),
                std::tan(40.0 * degree) / std::tan(angle * degree), 0.01);
  }
  EXPECT_LT(factor_of_safety(gravel, face(1.0, 0.5 * pi)), 0.1);
}

TEST(FaceStability, LoadsWithinTheSlipLowerIt) {
  const SoilState loam = soil(5000.0, 30.0 * degree);
  SoilFace wall = face(1.5, 0.5 * pi);
  const double bare = factor_of_safety(loam, wall);
  wall.loads.assign(20, 0.0);
  EXPECT_EQ(factor_of_safety(loam, wall), bare);
  wall.loads.assign(5, 20000.0);  // to 0.5 m from the edge
  EXPECT_LT(factor_of_safety(loam, wall), 0.8 * bare);
  wall.loads.assign(60, 0.0);
  for (std::size_t i = 40; i < 60; ++i) wall.loads[i] = 20000.0;  // from 4 m on
  EXPECT_NEAR(factor_of_safety(loam, wall), bare, 0.01 * bare);
}

TEST(FaceStability, TheStandingBatterIsTheSteepestWithTheFactor) {
  const SoilState loam = soil(2000.0, 30.0 * degree);
  SoilFace wall = face(3.0, 0.5 * pi);
  const auto batter = standing_batter(loam, wall, 1.3);
  ASSERT_TRUE(batter);
  wall.run = *batter * wall.height;
  EXPECT_GE(factor_of_safety(loam, wall), 1.3);
  wall.run -= 0.1 * wall.height;
  EXPECT_LT(factor_of_safety(loam, wall), 1.3);
  EXPECT_EQ(standing_batter(soil(50000.0, 0.3), wall, 1.3), 0.0);
  EXPECT_FALSE(standing_batter(soil(0.0, 10.0 * degree), wall, 1.3));
}

TEST(FaceStability, OddNumbersAreRefused) {
  const SoilState loam = soil(5000.0, 0.5);
  SoilFace wall = face(1.0, 0.5 * pi);
  wall.height = 0.0;
  EXPECT_THROW((void)factor_of_safety(loam, wall), Error);
  wall.height = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)factor_of_safety(loam, wall), Error);
  wall.height = 1.0;
  wall.loads = {-1.0};
  EXPECT_THROW((void)factor_of_safety(loam, wall), Error);
  wall.loads.clear();
  EXPECT_THROW((void)factor_of_safety(soil(-1.0, 0.5), wall), Error);
  EXPECT_THROW((void)factor_of_safety(loam, wall, 1.0), Error);
}

}  // namespace
}  // namespace excavplan::test
