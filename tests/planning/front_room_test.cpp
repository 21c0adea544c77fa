// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/front_room.hpp"
#include "ground/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "planning/dig_layout.hpp"

namespace excavplan {
namespace {

class FrontRoomOf : public testing::Test {
 protected:
  /// Level ground with a block on it.
  Terrain with_block(double height, double x_min, double x_max, double y_max = 2.0,
                     double y_min = -2.0) const {
    Terrain ground = level_planning_ground(machine_, 0.05);
    HeightMap& bank = ground.bank;
    for (Eigen::Index col = 0; col < bank.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < bank.z.rows(); ++row) {
        if (bank.x(col) < x_min || bank.x(col) > x_max) continue;
        if (bank.y(row) > y_min && bank.y(row) < y_max) bank.z(row, col) = height;
      }
    }
    return ground;
  }

  std::variant<DigPath, Infeasible> laid(const Terrain& ground) const {
    return DigLayout(machine_, ground).path_from({0.9, 0.5, 1.0}, 6.0);
  }

  DigPlan planned(const Terrain& ground) const {
    PlanOptions options;
    options.method = PlanMethod::search;
    options.search.stop.evaluations = 40;
    return plan_dig(machine_, loam_, 40.0, ground, options);
  }

  static bool warns(const DigPlan& plan, const std::string& code) {
    for (const Warning& warning : plan.warnings) {
      if (code_text(warning.code) == code) return true;
    }
    return false;
  }

  /// Lowest height of boom and arm over this place in any pose, by points along the links.
  double lowest_at(const DigPath& path, double x_min, double x_max) const {
    double lowest = 100.0;
    for (const auto* poses : {&path.approach, &path.poses}) {
      for (const DigPose& pose : *poses) {
        const LinkPositions at = link_positions(machine_, pose.joints);
        for (double share = 0.0; share <= 1.0; share += 0.001) {
          for (const Eigen::Vector2d& point :
               {Eigen::Vector2d(machine_.boom_pin + share * (at.arm_pin - machine_.boom_pin)),
                Eigen::Vector2d(at.arm_pin + share * (at.bucket_pin - at.arm_pin))}) {
            if (point.x() > x_min && point.x() < x_max) lowest = std::min(lowest, point.y());
          }
        }
      }
    }
    return lowest;
  }

  const Machine machine_ = load_machine(find_data_file("machines/zx120.json"));
  const SoilKind loam_ = load_soil(find_data_file("soils/loam.json"));
};

TEST_F(FrontRoomOf, ABlockTouchesALinkThatComesWithinTheMarginOfIt) {
  const auto free = laid(level_planning_ground(machine_));
  const auto* path = std::get_if<DigPath>(&free);
  ASSERT_TRUE(path);
  const double lowest = lowest_at(*path, 3.0, 3.2);
  ASSERT_GT(lowest, 0.5);
  ASSERT_LT(lowest, 4.0);
  EXPECT_TRUE(std::holds_alternative<DigPath>(laid(with_block(lowest - 0.15, 3.0, 3.2))));
  const auto blocked = laid(with_block(lowest - 0.05, 3.0, 3.2));
  ASSERT_TRUE(std::holds_alternative<Infeasible>(blocked));
  const Infeasible& reason = std::get<Infeasible>(blocked);
  EXPECT_EQ(reason.reason, Infeasible::Reason::front_contact);
  EXPECT_NEAR(reason.limit, lowest - 0.05, 1e-12);
  EXPECT_NE(reason.message.find(" would pass through the ground at x = 3."), std::string::npos)
      << reason.message;
}

TEST_F(FrontRoomOf, ALinkThatHangsBetweenTheCentresOfTwoColumnsIsSeen) {
  const FrontRoom room(with_block(2.0, 4.0, 5.0), machine_);
  LinkPositions hanging;
  hanging.arm_pin = {4.511, 3.0};  // cells of 5 cm, their centres at 4.475 and 4.525
  hanging.bucket_pin = {4.489, 1.0};
  const auto contact = room.contact(hanging);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->x, 4.5, 0.03);
  EXPECT_EQ(contact->z, 2.0);
}

/// As to every side of it.
TEST_F(FrontRoomOf, WhatStandsIsKeptClearOfInFrontOfItAndBehindIt) {
  const Terrain post = with_obstacles(with_block(2.0, 5.0, 5.2, 0.1, -0.1));
  ASSERT_GT(post.obstacles.size(), 0);
  const FrontRoom room(post, machine_);
  const auto touches = [&](double x) {
    LinkPositions hanging;
    hanging.arm_pin = {x, 4.0};
    hanging.bucket_pin = {x, 2.05};
    hanging.along.fill(Eigen::Vector2d::UnitY());  // the bucket is turned up
    return room.contact(hanging).has_value();
  };
  for (const double x : {4.92, 5.1, 5.28}) EXPECT_TRUE(touches(x)) << x;
  for (const double x : {4.82, 5.38}) EXPECT_FALSE(touches(x)) << x;
}

TEST_F(FrontRoomOf, WhatStandsBesideTheLinksOrUnderTheMachineIsNotInTheirWay) {
  EXPECT_TRUE(std::holds_alternative<DigPath>(laid(with_block(3.0, 3.0, 3.2, 2.0, 0.35))));
  EXPECT_TRUE(std::holds_alternative<Infeasible>(laid(with_block(3.0, 3.0, 3.2, 2.0, 0.1))));
  EXPECT_TRUE(std::holds_alternative<DigPath>(laid(with_block(3.0, 0.9, 1.7))));
}

TEST_F(FrontRoomOf, NoPlanGoesThroughAWall) {
  for (const double height : {0.8, 2.4, 6.0}) {
    const DigPlan plan = planned(with_block(height, 2.9, 3.1));
    if (!plan.dig) continue;
    EXPECT_GT(lowest_at(plan.path, 2.9, 3.1), height) << height;
  }
  EXPECT_TRUE(planned(with_block(0.8, 2.9, 3.1)).dig);
  EXPECT_FALSE(planned(with_block(6.0, 2.9, 3.1)).dig);
}

/// However wide it is, a box that stands in the strip of the bucket is neither dug nor touched.
TEST_F(FrontRoomOf, NoDigGoesThroughWhatStandsInTheStrip) {
  for (const double half : {0.1, 0.35, 0.8}) {
    const DigPlan plan = planned(with_block(0.9, 4.6, 4.8, half, -half));
    EXPECT_TRUE(warns(plan, "obstacle_in_strip"));
    if (!plan.dig) continue;
    EXPECT_TRUE(plan.trustworthy);
    const Rectangle strip = swept_strip(machine_, plan.path);
    EXPECT_TRUE(strip.x_max < 4.5 || strip.x_min > 4.9) << strip.x_min << " .. " << strip.x_max;
    EXPECT_GT(lowest_at(plan.path, 4.55, 4.85), 1.0);
  }
  EXPECT_FALSE(warns(planned(with_block(0.3, 4.6, 4.8, 0.1, -0.1)), "obstacle_in_strip"));
}

TEST_F(FrontRoomOf, WhatStandsBesideTheStripIsNotSaidToStandInIt) {
  const double half = 0.5 * machine_.bucket.width_outside;
  for (const double side : {1.0, -1.0}) {
    const auto from = [&](double y) {
      const double near = side * y, far = side * (y + 0.5);
      return planned(with_block(0.9, 4.6, 4.8, std::max(near, far), std::min(near, far)));
    };
    EXPECT_FALSE(warns(from(half + 0.1), "obstacle_in_strip")) << side;
    EXPECT_TRUE(warns(from(half - 0.1), "obstacle_in_strip")) << side;
  }
}

/// The bucket too keeps clear of what stands beside the strip.
TEST_F(FrontRoomOf, TheBucketKeepsClearOfAPostBesideTheStrip) {
  const auto beside = [&](double y) {
    return with_obstacles(with_block(2.0, 5.0, 5.2, y + 0.1, y));
  };
  EXPECT_TRUE(std::holds_alternative<DigPath>(laid(beside(0.55))));
  EXPECT_TRUE(std::holds_alternative<Infeasible>(laid(beside(0.4))));
}

TEST_F(FrontRoomOf, AWallBesideAPitThatIsDugDeeperIsNoObstacle) {
  const DigPlan plan = planned(with_block(-0.8, 2.0, 8.5, 0.6, -0.6));
  ASSERT_TRUE(plan.dig);
  EXPECT_FALSE(warns(plan, "obstacle_in_strip"));
}

}  // namespace
}  // namespace excavplan
