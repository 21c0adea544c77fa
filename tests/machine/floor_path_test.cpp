// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <excavplan/machine/dig_path.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::error_of;
using test::zx120;

double level(double) { return 0.0; }

DigPathOptions over(const GroundProfile& floor) {
  DigPathOptions options;
  options.floor = floor;
  return options;
}

/// How far tip and bucket come below a floor where they dig.
double deepest_below(const DigPath& path, const GroundProfile& floor) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const DigPose& pose : path.poses) {
    const LinkPositions at = link_positions(zx120(), pose.joints);
    std::vector<Eigen::Vector2d> points = {at.tip};
    for (const Eigen::Vector2d& corner : zx120().bucket.profile) {
      points.push_back(bucket_point(at, corner));
    }
    for (const Eigen::Vector2d& point : points) {
      if (point.x() > path.start_x || pose.phase == DigPhase::penetrate) continue;
      worst = std::max(worst, floor(point.x()) - point.y());
    }
    worst = std::max(worst, floor(at.tip.x()) - at.tip.y());
  }
  return worst;
}

TEST(FloorPath, NoPartOfTheBucketCutsBelowTheFloor) {
  Random random(41);
  int driven = 0;
  for (int i = 0; i < 400; ++i) {
    const double depth = random.uniform(0.05, 1.0);
    const double grade = random.uniform(-0.15, 0.15);
    const GroundProfile floor = [=](double x) { return -depth + grade * (x - 5.0); };
    DigPathOptions options = over(floor);
    options.drag_grade = random.uniform(-0.2, 0.2);
    const DigParameters wanted = {random.uniform(0.2, 1.3), random.uniform(0.1, 1.5),
                                  random.uniform(0.3, 3.0)};
    const auto outcome = make_dig_path(zx120(), wanted, random.uniform(4.5, 8.0), level, options);
    const auto* path = std::get_if<DigPath>(&outcome);
    if (path == nullptr) continue;
    ++driven;
    EXPECT_LT(deepest_below(*path, floor), 1e-9) << "case " << i;
    const LinkPositions end = link_positions(zx120(), path->poses.back().joints);
    EXPECT_GT(end.tip.y(), 0.0) << "case " << i;
  }
  EXPECT_GT(driven, 60);
}

TEST(FloorPath, IsThatWithoutFloorWhereTheFloorIsDeepEnough) {
  const DigParameters paper = paper_fixed_path();
  const auto free = std::get<DigPath>(make_dig_path(zx120(), paper, 6.0, level));
  const auto over_deep = std::get<DigPath>(
      make_dig_path(zx120(), paper, 6.0, level, over([](double) { return -3.0; })));
  ASSERT_EQ(free.poses.size(), over_deep.poses.size());
  EXPECT_FALSE(over_deep.meets_floor);
  for (std::size_t i = 0; i < free.poses.size(); ++i) {
    EXPECT_EQ(free.poses[i].joints, over_deep.poses[i].joints);
  }
}

TEST(FloorPath, PenetrationEndsOnTheFloorAndTheDragFollowsIt) {
  const GroundProfile floor = [](double x) { return -0.3 + 0.02 * (x - 6.0); };
  const auto path =
      std::get<DigPath>(make_dig_path(zx120(), {45 * degree, 2.0, 1.5}, 6.5, level, over(floor)));
  EXPECT_TRUE(path.meets_floor);
  double last_penetrated = 0.0;
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::penetrate) last_penetrated = pose.bucket.z - floor(pose.bucket.x);
  }
  EXPECT_NEAR(last_penetrated, 0.0, 1e-9);
  // The floor falls towards the machine: level is higher than it, so the drag leaves it.
  EXPECT_NEAR(path.parameters.penetration_length * std::sin(45 * degree), 0.296, 0.01);
}

TEST(FloorPath, FinishingPassKeepsEdgeOnTheFloorAndItsAngle) {
  const GroundProfile floor = [](double x) { return -0.5 - 0.01 * (x - 5.0); };
  const GroundProfile ground = [&](double x) { return floor(x) + 0.03; };
  DigPathOptions options = over(floor);
  options.drag_keeps_angle = true;
  options.drag_grade = -std::atan(0.01);
  const auto outcome = make_dig_path(zx120(), {15 * degree, 1.0, 2.0}, 6.0, ground, options);
  if (const auto* stop = std::get_if<Infeasible>(&outcome)) FAIL() << stop->message;
  const auto& path = std::get<DigPath>(outcome);
  int on_floor = 0;
  for (const DigPose& pose : path.poses) {
    if (pose.phase != DigPhase::drag) continue;
    EXPECT_NEAR(pose.bucket.z, floor(pose.bucket.x), 1e-6);
    EXPECT_NEAR(pose.bucket.floor_angle, 15 * degree, 1e-9);
    ++on_floor;
  }
  EXPECT_GE(on_floor, 70);
}

/// A trench across the dig, 0.5 m deep and 1 m wide at its foot, its faces 1.73:1.
double battered(double x) {
  const double from_middle = std::abs(x - 5.0);
  return std::min(0.0, -0.5 + std::max(0.0, from_middle - 0.5) / 1.73);
}

TEST(FloorPath, SweepsDownOneFaceAndUpTheOther) {
  DigPathOptions options = over(battered);
  options.drag_follows_floor = true;
  const auto outcome = make_dig_path(zx120(), {0.75, 1.0, 2.6}, 6.35, battered, options);
  if (const auto* stop = std::get_if<Infeasible>(&outcome)) FAIL() << stop->message;
  const auto& path = std::get<DigPath>(outcome);
  EXPECT_LT(deepest_below(path, battered), 1e-9);
  int on_floor = 0, on_near_face = 0;
  for (const DigPose& pose : path.poses) {
    if (pose.phase != DigPhase::drag) continue;
    EXPECT_NEAR(pose.bucket.z, battered(pose.bucket.x), 0.005);
    if (std::abs(pose.bucket.x - 5.0) < 0.2) {
      EXPECT_NEAR(pose.bucket.floor_angle, 0.45, 0.12);
      ++on_floor;
    }
    if (pose.bucket.x > 3.95 && pose.bucket.x < 4.2) {
      EXPECT_NEAR(pose.bucket.floor_angle, 0.45 - std::atan(1.0 / 1.73), 0.12);
      ++on_near_face;
    }
  }
  EXPECT_GE(on_floor, 10);
  EXPECT_GE(on_near_face, 5);
}

TEST(FloorPath, SweepsNothingWithoutAFloor) {
  DigPathOptions options;
  options.drag_follows_floor = true;
  const auto error = error_of([&] {
    return make_dig_path(zx120(), {0.75, 0.3, 1.0}, 6.0, level, options);
  });
  EXPECT_NE(error.find("drag_follows_floor needs"), std::string::npos) << error;
}

TEST(FloorPath, SweepsOnLevelWhereTheFloorIsNotKnown) {
  const GroundProfile ends = [](double x) { return x < 5.0 ? std::nan("") : -0.3; };
  DigPathOptions options = over(ends);
  options.drag_follows_floor = true;
  const auto path = std::get<DigPath>(make_dig_path(zx120(), {0.6, 1.0, 1.2}, 6.0, level, options));
  for (const DigPose& pose : path.poses) {
    if (pose.phase != DigPhase::drag) continue;
    EXPECT_NEAR(pose.bucket.z, -0.3, 1e-6);
  }
}

TEST(FloorPath, DragFollowsItsGrade) {
  DigPathOptions options;
  options.drag_grade = 0.2;
  const auto path =
      std::get<DigPath>(make_dig_path(zx120(), {60 * degree, 0.2, 1.0}, 6.0, level, options));
  const DigPose* first = nullptr;
  const DigPose* last = nullptr;
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::penetrate) first = &pose;
    if (pose.phase == DigPhase::drag) last = &pose;
  }
  ASSERT_TRUE(first != nullptr && last != nullptr);
  EXPECT_NEAR((first->bucket.z - last->bucket.z) / (first->bucket.x - last->bucket.x),
              std::tan(0.2), 1e-9);
  EXPECT_EQ(path.drag_grade, 0.2);
}

TEST(FloorPath, BeginsOnTheFloorWhereTheGroundIsBelowIt) {
  const auto path = std::get<DigPath>(make_dig_path(
      zx120(), {30 * degree, 0.5, 1.0}, 6.0, [](double) { return -0.2; },
      over([](double) { return -0.1; })));
  EXPECT_EQ(path.poses.front().bucket.z, -0.1);
  EXPECT_EQ(path.parameters.penetration_length, 0.0);
}

TEST(FloorPath, GradeOutOfRangeIsRefused) {
  DigPathOptions options;
  options.drag_grade = 1.5;
  EXPECT_EQ(error_of([&] {
              (void)make_dig_path(zx120(), paper_fixed_path(), 6.0, level, options);
            }).substr(0, 26),
            "DigPathOptions::drag_grade");
}

}  // namespace
}  // namespace excavplan
