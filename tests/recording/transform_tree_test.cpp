// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/transform_tree.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/non_finite.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

constexpr std::int64_t millisecond = 1000000;
constexpr std::int64_t start = 1700000000000 * millisecond;
constexpr double half = 0.70710678118654752;

StampedTransform link(const std::string& parent, const std::string& child,
                      const Eigen::Vector3d& translation = {0.0, 0.0, 0.0},
                      const Eigen::Vector4d& rotation = {0.0, 0.0, 0.0, 1.0}) {
  return {parent, child, start, rotation, translation, true};
}

/// About z [rad].
Eigen::Vector4d yaw(double angle) {
  return {0.0, 0.0, std::sin(0.5 * angle), std::cos(0.5 * angle)};
}

StampedTransform at(std::int64_t time, StampedTransform transform) {
  transform.stamp = start + time;
  transform.is_static = false;
  return transform;
}

TransformTree tree_of(std::vector<StampedTransform> transforms) {
  return {"run.mcap", start, std::move(transforms)};
}

Eigen::Vector3d put(const TransformTree& tree, const std::string& target, const std::string& source,
                    const Eigen::Vector3d& point, std::int64_t time = 0) {
  return tree.lookup(target, source, start + time) * point;
}

std::string error_of_lookup(const TransformTree& tree, const std::string& target,
                            const std::string& source, std::int64_t time = 0) {
  return error_about([&] { tree.lookup(target, source, start + time); }, "run.mcap");
}

void expect_at(const Eigen::Vector3d& found, const Eigen::Vector3d& expected) {
  EXPECT_LT((found - expected).norm(), 1e-12) << found.transpose() << " / " << expected.transpose();
}

TEST(TransformTree, ChainsUpAndDown) {
  // base in map: 90 deg to the left at (10, 0, 0); lidar in base: at (1, 0, 2)
  const TransformTree tree =
      tree_of({link("map", "base", {10.0, 0.0, 0.0}, {0.0, 0.0, half, half}),
               link("base", "lidar", {1.0, 0.0, 2.0}), link("base", "camera", {0.0, 3.0, 0.0})});
  expect_at(put(tree, "map", "lidar", {5.0, 0.0, 0.0}), {10.0, 6.0, 2.0});
  expect_at(put(tree, "lidar", "map", {10.0, 6.0, 2.0}), {5.0, 0.0, 0.0});
  expect_at(put(tree, "camera", "lidar", {0.0, 0.0, 0.0}), {1.0, -3.0, 2.0});
  expect_at(put(tree, "base", "base", {1.0, 2.0, 3.0}), {1.0, 2.0, 3.0});
  expect_at(put(tree, "nowhere", "nowhere", {1.0, 2.0, 3.0}), {1.0, 2.0, 3.0});
}

TEST(TransformTree, InterpolatesBetweenStamps) {
  // from 0 to 90 deg and from x = 0 to 4 within 0.8 s
  const TransformTree tree =
      tree_of({at(800 * millisecond, link("map", "base", {4.0, 0.0, 0.0}, yaw(M_PI_2))),
               at(0, link("map", "base"))});
  const double quarter = M_PI_2 / 4.0;
  expect_at(put(tree, "map", "base", {1.0, 0.0, 0.0}, 200 * millisecond),
            {1.0 + std::cos(quarter), std::sin(quarter), 0.0});
  expect_at(put(tree, "map", "base", {1.0, 0.0, 0.0}, 400 * millisecond), {2.0 + half, half, 0.0});
  expect_at(put(tree, "map", "base", {1.0, 0.0, 0.0}, 800 * millisecond), {4.0, 1.0, 0.0});
}

TEST(TransformTree, InterpolatesAlongTheShorterArcWhateverTheSignOfAQuaternion) {
  const TransformTree tree =
      tree_of({at(0, link("map", "base", {0.0, 0.0, 0.0}, yaw(0.2))),
               at(500 * millisecond, link("map", "base", {0.0, 0.0, 0.0}, -yaw(0.6)))});
  expect_at(put(tree, "map", "base", {1.0, 0.0, 0.0}, 250 * millisecond),
            {std::cos(0.4), std::sin(0.4), 0.0});
}

TEST(TransformTree, HoldsForATenthOfASecondAndNoLonger) {
  const TransformTree tree =
      tree_of({at(1000 * millisecond, link("map", "base", {1.0, 0.0, 0.0})),
               at(1500 * millisecond, link("map", "base", {2.0, 0.0, 0.0}))});
  expect_at(put(tree, "map", "base", {0.0, 0.0, 0.0}, 900 * millisecond), {1.0, 0.0, 0.0});
  expect_at(put(tree, "map", "base", {0.0, 0.0, 0.0}, 1600 * millisecond), {2.0, 0.0, 0.0});
  EXPECT_EQ(
      error_of_lookup(tree, "map", "base", 899 * millisecond),
      "transform of 'base' in 'map' at 0.899 s: found it from 1.000 s to 1.500 s, expected it "
      "at that time");
  EXPECT_NE(error_of_lookup(tree, "map", "base", 1601 * millisecond), "no error");
  EXPECT_NE(error_of_lookup(tree, "base", "map", 1601 * millisecond), "no error");
}

TEST(TransformTree, DoesNotGuessWhatHappenedInALongGap) {
  const TransformTree moved =
      tree_of({at(0, link("map", "base")),
               at(1100 * millisecond, link("map", "base", {0.0, 0.0, 0.0}, yaw(0.01)))});
  EXPECT_EQ(error_of_lookup(moved, "map", "base", 500 * millisecond),
            "transform of 'base' in 'map' at 0.500 s: found it at 0.000 s and at 1.100 s, where it "
            "had moved, expected it every second");
  const TransformTree stood =
      tree_of({at(0, link("map", "base", {1.0, 0.0, 0.0})),
               at(60000 * millisecond, link("map", "base", {1.004, 0.0, 0.0}))});
  expect_at(put(stood, "map", "base", {0.0, 0.0, 0.0}, 30000 * millisecond), {1.002, 0.0, 0.0});
}

TEST(TransformTree, StaticOnesHoldAtAllTimesTheLastOneCounts) {
  const TransformTree tree =
      tree_of({link("base", "lidar", {1.0, 0.0, 0.0}), link("base", "lidar", {2.0, 0.0, 0.0})});
  expect_at(put(tree, "base", "lidar", {0.0, 0.0, 0.0}, -100000 * millisecond), {2.0, 0.0, 0.0});
}

TEST(TransformTree, MissingChainsNameWhereTheyBreak) {
  const TransformTree tree =
      tree_of({link("map", "odom"), link("base", "mast"), link("mast", "lidar")});
  EXPECT_EQ(
      error_of_lookup(tree, "map", "lidar"),
      "found no transforms that lead from 'lidar' to 'map': those of 'lidar' end at 'base', "
      "those of 'map' at 'map'; the frames there are: 'base', 'lidar', 'map', 'mast', 'odom'");
  EXPECT_EQ(error_of_lookup(tree, "mapp", "lidar"),
            "found no transform of frame 'mapp', did you mean 'map'? the frames there are: 'base', "
            "'lidar', 'map', 'mast', 'odom'");
  EXPECT_EQ(error_of_lookup(tree_of({}), "map", "lidar"),
            "found no transforms on /tf and /tf_static, expected those of 'map'");
}

TEST(TransformTree, TwoParentsAreRefusedWhereTheyMatter) {
  const TransformTree tree =
      tree_of({link("map", "base"), link("odom", "base"), link("base", "lidar", {1.0, 0.0, 0.0})});
  EXPECT_EQ(error_of_lookup(tree, "map", "lidar"),
            "found transforms of 'base' in 'map' and in 'odom', expected one parent of each frame");
  expect_at(put(tree, "base", "lidar", {0.0, 0.0, 0.0}), {1.0, 0.0, 0.0});
}

TEST(TransformTree, CyclesAreRefused) {
  const TransformTree tree =
      tree_of({link("a", "b"), link("b", "c"), link("c", "a"), link("x", "y")});
  EXPECT_EQ(error_of_lookup(tree, "x", "c"),
            "found more than 1000 frames above 'c', expected a tree without a cycle");
  EXPECT_NE(error_of_lookup(tree_of({link("a", "a"), link("x", "y")}), "x", "a"), "no error");
  EXPECT_FALSE(tree.moved("", "a", start, start));
}

TEST(TransformTree, WhatIsNoMotionIsRefused) {
  const TransformTree zero = tree_of({link("map", "base", {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0, 0.0})});
  EXPECT_EQ(
      error_of_lookup(zero, "map", "base"),
      "transform of 'base' in 'map' at 0.000 s: found the quaternion and translation 0 0 0 0 1 "
      "2 3, expected a quaternion of length 1 and a finite translation");
  EXPECT_NE(error_of_lookup(tree_of({link("map", "base", {nan, 0.0, 0.0})}), "map", "base"),
            "no error");
  EXPECT_NE(error_of_lookup(tree_of({link("map", "base", {0.0, 0.0, 0.0}, {nan, 0.0, 0.0, 1.0})}),
                            "map", "base"),
            "no error");
  // a quaternion that was rounded is a rotation all the same
  const TransformTree rounded =
      tree_of({link("map", "base", {0.0, 0.0, 0.0}, {0.0, 0.0, 0.707, 0.707})});
  expect_at(put(rounded, "map", "base", {1.0, 0.0, 0.0}), {0.0, 1.0, 0.0});
}

TEST(TransformTree, MovedBeyondOneCentimetreOrATenthOfADegree) {
  const auto moved = [](const Eigen::Vector3d& shift, double turn) {
    const TransformTree tree = tree_of(
        {at(0, link("map", "base")), at(400 * millisecond, link("map", "base", shift, yaw(turn))),
         at(800 * millisecond, link("map", "base")), link("base", "lidar")});
    return tree.moved("", "lidar", start + 100 * millisecond, start + 700 * millisecond);
  };
  EXPECT_FALSE(moved({0.0, 0.0, 0.0}, 0.0));
  EXPECT_FALSE(moved({0.009, 0.0, 0.0}, 0.0017));
  EXPECT_TRUE(moved({0.011, 0.0, 0.0}, 0.0));
  EXPECT_TRUE(moved({0.0, 0.0, 0.0}, 0.0018));
}

TEST(TransformTree, MovesOnlyInTheFramesBetween) {
  const TransformTree tree =
      tree_of({at(0, link("map", "base")),
               at(500 * millisecond, link("map", "base", {1.0, 0.0, 0.0})), link("base", "lidar")});
  EXPECT_TRUE(tree.moved("", "lidar", start, start + 500 * millisecond));
  EXPECT_TRUE(tree.moved("map", "lidar", start, start + 500 * millisecond));
  EXPECT_FALSE(tree.moved("base", "lidar", start, start + 500 * millisecond));
}

TEST(TransformTree, LeavesAreWhatNothingHangsOn) {
  const TransformTree tree = tree_of({link("map", "base"), link("base", "lidar")});
  EXPECT_TRUE(tree.is_leaf("lidar"));
  EXPECT_FALSE(tree.is_leaf("base"));
  EXPECT_FALSE(tree.is_leaf("map"));
  EXPECT_FALSE(tree.is_leaf("nowhere"));
  EXPECT_EQ(tree.frames(), (std::vector<std::string>{"base", "lidar", "map"}));
}

TEST(TransformTree, TimesFarAwayAreNamedAsTheyAre) {
  const TransformTree tree = tree_of({at(0, link("map", "base"))});
  EXPECT_EQ(
      error_of_lookup(tree, "map", "base", 12500 * millisecond - start),
      "transform of 'base' in 'map' at 12.500 s since 1970: found it from 0.000 s to 0.000 s, "
      "expected it at that time");
}

}  // namespace
}  // namespace excavplan::test
