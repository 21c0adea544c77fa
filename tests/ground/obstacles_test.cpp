// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/obstacles.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace excavplan {
namespace {

using Height = std::function<double(double x, double y)>;

HeightMap square_map(const Height& height) {
  HeightMap map = flat_ground({0.0, -4.0, 9.0, 4.0}, 0.05);
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      map.z(row, col) = height(map.x(col), map.y(row));
    }
  }
  return map;
}

/// Found area [m^2].
double found(const Height& height) {
  return static_cast<double>(find_obstacles(square_map(height)).count()) * 0.05 * 0.05;
}

Height box(double length, double width, double height) {
  return [=](double x, double y) {
    return std::abs(x - 4.5) < 0.5 * length && std::abs(y) < 0.5 * width ? height : 0.0;
  };
}

TEST(Obstacles, BoxesOfAnyWidthStandOnTheGround) {
  EXPECT_NEAR(found(box(0.1, 0.1, 4.0)), 0.01, 0.001);
  EXPECT_NEAR(found(box(0.2, 6.0, 2.0)), 1.2, 0.05);
  EXPECT_NEAR(found(box(0.7, 0.7, 0.8)), 0.49, 0.03);
  EXPECT_NEAR(found(box(5.0, 2.5, 2.6)), 12.5, 0.3);
}

TEST(Obstacles, LowThingsPitsSlopesAndHeapsAreGround) {
  EXPECT_EQ(found(box(1.0, 1.0, 0.4)), 0.0);
  EXPECT_EQ(found(box(1.0, 1.0, -1.5)), 0.0);
  EXPECT_EQ(found(box(6.0, 0.9, -1.2)), 0.0);
  EXPECT_EQ(found([](double x, double) { return 0.7 * x; }), 0.0);
  EXPECT_EQ(
      found([](double x, double y) { return std::max(0.0, 1.5 - 0.7 * std::hypot(x - 4.5, y)); }),
      0.0);
}

/// A bench goes on over the edge of the map.
TEST(Obstacles, ABenchIsGround) {
  EXPECT_EQ(found([](double x, double) { return x > 5.0 ? 2.5 : 0.0; }), 0.0);
}

TEST(Obstacles, UnknownGroundAroundDoesNotHideABox) {
  HeightMap map = square_map(box(2.0, 2.0, 2.0));
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    if (map.x(col) > 5.5) map.z.col(col).setConstant(std::nan(""));
  }
  const CellMask mask = find_obstacles(map);
  EXPECT_NEAR(static_cast<double>(mask.count()) * 0.0025, 4.0, 0.2);
}

TEST(Obstacles, TheGroundBelowIsUnknownAndTheirTopIsKept) {
  const Terrain ground = with_obstacles(undisturbed(square_map(box(0.7, 0.7, 0.8))));
  const auto row = ground.bank.z.rows() / 2, col = ground.bank.z.cols() / 2;
  EXPECT_TRUE(std::isnan(ground.bank.z(row, col)));
  EXPECT_EQ(ground.obstacles(row, col), 0.8);
  EXPECT_EQ(ground.highest().z(row, col), 0.8);
  EXPECT_TRUE(std::isnan(ground.obstacles(5, 5)));
  EXPECT_EQ(ground.highest().z(5, 5), 0.0);
  EXPECT_EQ(with_obstacles(undisturbed(square_map(box(0.7, 0.7, 0.3)))).obstacles.size(), 0);
}

}  // namespace
}  // namespace excavplan
