// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/workspace.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/kit/machine_kit.hpp>
#include <excavplan/machine/kinematics.hpp>

#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using test::zx120;

std::set<std::string> codes_of(const Machine& machine, const DataSheet& sheet = {}) {
  std::set<std::string> codes;
  for (const Warning& warning : check_machine(machine, sheet))
    codes.insert(code_text(warning.code));
  return codes;
}

// Those that a sweep of all joints finds: tests/machine/machine_test.cpp.
TEST(Workspace, ReachIsThatOfTheSweep) {
  const Reach reach = reach_of(zx120());
  EXPECT_NEAR(reach.ground, 8.15, 0.01);
  EXPECT_NEAR(reach.depth, 5.52, 0.005);
  EXPECT_NEAR(reach.height, 8.54, 0.005);
  EXPECT_DOUBLE_EQ(reach.highest.y(), reach.height);
  EXPECT_DOUBLE_EQ(reach.deepest.y(), -reach.depth);
  // The front is stretched up with all joints at their lower limits, and down in line.
  const auto& limits = zx120().limits;
  const JointAngles up(limits[0].lower, limits[1].lower, limits[2].lower);
  EXPECT_LT((link_positions(zx120(), up).tip - reach.highest).norm(), 1e-9);
  double off = 1.0;
  for (const Eigen::Vector2d& point : reach_outline(zx120())) {
    off = std::min(off, (point - reach.deepest).norm());
  }
  EXPECT_LT(off, 0.1);
}

TEST(Workspace, ABoomThatRisesPastTheVerticalReachesHighestStraightUp) {
  Machine machine = zx120();
  machine.limits[0].lower = -2.6;
  machine.limits[1].lower = machine.limits[2].lower = 0.0;
  const Reach reach = reach_of(machine);
  EXPECT_NEAR(reach.height, machine.boom_pin.y() + machine.full_length(), 1e-9);
  EXPECT_NEAR(reach.highest.x(), machine.boom_pin.x(), 1e-9);
}

TEST(Workspace, AFrontHeldUpReachesNoGround) {
  Machine machine = zx120();
  machine.limits[0].upper = machine.limits[0].lower + 0.2;
  const Reach reach = reach_of(machine);
  EXPECT_EQ(reach.ground, 0.0);
  EXPECT_LT(reach.depth, 0.0);
}

TEST(Workspace, ForceIsThatOfTheCatalogueOrOfFriction) {
  EXPECT_NEAR(bucket_force(zx120()), 99e3, 1.0);
  EXPECT_NEAR(arm_force(zx120()), 63e3, 1.0);
  const DiggingForce force = digging_force(zx120(), {5.0, 0.0});
  EXPECT_NEAR(force.held, 0.6 * 9.80665 * 12700.0, 1.0) << "it slides before it tips";
  EXPECT_GT(force.joints, 50e3);
  EXPECT_TRUE(std::isinf(digging_force(test::zx120_held_down(), {5.0, 0.0}).held));
  EXPECT_TRUE(std::isnan(digging_force(zx120(), {20.0, 0.0}).joints)) << "out of reach";
}

/// With one angle of the bucket there is one posture for a place.
Machine with_bucket_at(double angle) {
  Machine machine = zx120();
  machine.limits[2].lower = machine.limits[2].upper = angle;
  return machine;
}

// Above the boom pin the soil turns the boom down, as its weight does, below the pin up.
TEST(Workspace, TheForceTakesAllThatOneJointHasBesideTheWeightAndNoMore) {
  for (const auto& [bucket, z] : {std::pair{1.0, -1.0}, {1.0, 0.5}, {1.5, 2.5}, {1.5, 3.5}}) {
    Machine machine = with_bucket_at(bucket);
    machine.limits[0].torque = 70e3;
    const Eigen::Vector2d tip(5.5, z);
    const DiggingForce force = digging_force(machine, tip);
    const LinkPositions links = link_positions(
        machine,
        std::get<JointAngles>(inverse_kinematics_fixed_bucket(machine, tip.x(), tip.y(), bucket)));
    const JointAngles torque = torque_against_force(machine, links, tip, {force.joints, 0.0}) +
                               torque_against_link_weight(machine, links);
    double used = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      used = std::max(used, std::abs(torque[static_cast<int>(i)]) / machine.limits[i].torque);
    }
    EXPECT_NEAR(used, 1.0, 1e-9) << z;
  }
}

TEST(Workspace, ThereIsNoForceWithTheFloorOfTheBucketTooSteepOrTooFlat) {
  const auto force = [](double angle) { return digging_force(with_bucket_at(angle), {5.0, 0.0}); };
  EXPECT_TRUE(std::isnan(force(-0.4).joints));
  EXPECT_GT(force(1.0).joints, 0.0);
  EXPECT_TRUE(std::isnan(force(2.0).joints));
}

// The boom as a weight at its pin, which turns no joint, is a part of the body.
TEST(Workspace, WeightHoldsAlikeWhateverPartItIsOf) {
  Machine apart = zx120();
  apart.links = {{{3000.0, 0.0, 0.0}, {}, {}}};
  apart.boom_pin.x() = 0.8;
  apart.body->track_friction = 5.0;  // it tips before it slides
  Machine one = apart;
  one.links = {};
  one.body->mass += 3000.0;
  one.body->centre =
      (apart.body->mass * apart.body->centre + 3000.0 * apart.boom_pin) / one.body->mass;
  const double held = digging_force(one, {5.0, -2.0}).held;
  EXPECT_LT(held, 0.9 * 5.0 * 9.80665 * one.body->mass);
  EXPECT_NEAR(digging_force(apart, {5.0, -2.0}).held, held, 1e-9 * held);
}

TEST(Workspace, TheOutlineIsWithinTheReach) {
  const Reach reach = reach_of(zx120());
  for (const Eigen::Vector2d& point : reach_outline(zx120())) {
    EXPECT_LE(point.y(), reach.height + 1e-3);
    EXPECT_GE(point.y(), -reach.depth - 1e-3);
  }
}

TEST(Workspace, WarnsOfWhatDoesNotFit) {
  EXPECT_TRUE(codes_of(zx120()).empty());
  Machine machine = zx120();
  machine.limits[0].upper = machine.limits[0].lower + 0.2;
  EXPECT_EQ(codes_of(machine).count("ground_out_of_reach"), 1U);
  machine = zx120();
  machine.track_front = 8.5;  // it reaches the ground under its tracks alone
  EXPECT_EQ(codes_of(machine).count("ground_out_of_reach"), 1U);
  machine = zx120();
  machine.body->mass = 2500.0;
  EXPECT_EQ(codes_of(machine), std::set<std::string>{"force_beyond_stability"});
  machine.body.reset();
  machine.engine.reset();
  EXPECT_EQ(codes_of(machine), (std::set<std::string>{"no_body", "no_cycle"}));
  DataSheet sheet;
  sheet.bucket_capacity = 0.5;
  EXPECT_EQ(codes_of(zx120(), sheet), std::set<std::string>{"data_sheet_differs"});
  sheet.bucket_capacity = 0.42;
  EXPECT_TRUE(codes_of(zx120(), sheet).empty());
}

TEST(Workspace, ShippedMachinesAreThoseOfTheirDataSheets) {
  for (const char* name : {"zx200", "generic-20t", "generic-mini"}) {
    const MachineFile file =
        load_machine_file(find_data_file("machines/" + std::string(name) + ".json"));
    EXPECT_EQ(file.machine.name, name);
    EXPECT_TRUE(check_machine(file.machine, file.data_sheet).empty()) << name;
  }
}

TEST(Workspace, ATenthBesideTheDataSheetIsTooMuch) {
  DataSheet sheet;
  for (const auto& [share, is_like_it] : {std::pair{1.08, true}, {0.92, true}, {1.13, false}}) {
    sheet.depth = share * reach_of(zx120()).depth;
    EXPECT_EQ(check_machine(zx120(), sheet).empty(), is_like_it) << share;
  }
}

// Its public model lifts 3 m with ease, a small one no higher than it can.
TEST(Workspace, DumpsNoHigherThanItReaches) {
  EXPECT_EQ(feasible_objective(zx120(), {}).dump_height, 3.0);
  Machine low = zx120();
  low.limits[0].lower = -0.35;
  const double height = feasible_objective(low, {}).dump_height;
  EXPECT_LT(height, 3.0);
  EXPECT_GT(height, 1.0);
}

}  // namespace
}  // namespace excavplan
