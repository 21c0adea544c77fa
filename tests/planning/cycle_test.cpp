// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_cycle.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/soil/soil.hpp>

#include "support/errors.hpp"

namespace excavplan {
namespace {

/// A machine whose cycle can be computed by hand: no mass but that of the upper structure and the
/// payload, no cylinders.
class Cycle : public testing::Test {
 protected:
  Cycle() {
    for (LinkMass& link : bare_.links) link.mass = 0.0;
    bare_.cylinders.reset();
    bare_.hydraulics.reset();
    bare_.swing = {1.5, 34e3, 15e3};
    bare_.engine = {60e3, 5e3};
    path_ = path_of(bare_);
  }

  static DigPath path_of(const Machine& machine) {
    return std::get<DigPath>(
        make_dig_path(machine, paper_fixed_path(), 6.0, [](double) { return 0.0; }));
  }
  static PlannedDig dig_of(double mass) { return {paper_fixed_path(), 6.0, mass, 0.3, 20e3, 5.0}; }
  DigCycle cycle(double mass, const CycleOptions& options = {}) const {
    return *cycle_of(bare_, path_, dig_of(mass), options);
  }
  static CycleOptions to_height(double height) {
    CycleOptions options;
    options.dump_height = height;
    return options;
  }
  static CycleOptions by_angle(double angle) {
    CycleOptions options;
    options.swing = angle;
    return options;
  }
  /// The scoop's last pose.
  JointAngles scooped() const {
    JointAngles joints = JointAngles::Zero();
    for (const DigPose& pose : path_.poses) {
      if (pose.phase == DigPhase::scoop) joints = pose.joints;
    }
    return joints;
  }
  double pin_height(const JointAngles& joints) const {
    return link_positions(bare_, joints).bucket_pin.y();
  }

  const Machine zx120_ = load_machine(find_data_file("machines/zx120.json"));
  Machine bare_ = zx120_;
  DigPath path_;
};

TEST_F(Cycle, LiftTakesTheWeightTimesTheHeight) {
  const double from = pin_height(scooped());
  for (const double height : {2.5, 3.0, 3.5}) {
    const double mgh = 500.0 * gravity * (height - from);  // the bucket keeps its attitude
    EXPECT_NEAR(cycle(500.0, to_height(height)).lift.energy, mgh, 1e-3 * mgh) << height;
  }
  bare_.links[1] = {400.0, bare_.arm_length, 0.0};  // a weight at the bucket pin
  const double of_link = 400.0 * gravity * (3.0 - from);
  EXPECT_NEAR(cycle(0.0).lift.energy, of_link, 1e-3 * of_link);
}

TEST_F(Cycle, TheArmHelpsWhereTheBoomAloneDoesNotReach) {
  const JointAngles from = scooped();
  JointAngles boom_up = from;
  boom_up[0] = bare_.limits[0].lower;
  const double boom_alone = pin_height(boom_up);
  const double low = cycle(500.0, to_height(boom_alone - 0.1)).lift.energy;
  const double high = cycle(500.0, to_height(boom_alone + 0.9)).lift.energy;
  EXPECT_GT(high - low, 0.5 * 500.0 * gravity);
}

TEST_F(Cycle, NeverLiftsLessThanClearOfTheGround) {
  const double clear = pin_height(path_.poses.back().joints);
  const double mgh = 500.0 * gravity * (clear - pin_height(scooped()));
  EXPECT_NEAR(cycle(500.0, to_height(0.0)).lift.energy, mgh, 1e-3 * mgh);
}

TEST_F(Cycle, SwingThatReachesItsRateTakesHalfJOmegaSquared) {
  const DigCycle empty = cycle(0.0);
  EXPECT_NEAR(empty.swing.energy, 0.5 * 15e3 * 1.5 * 1.5, 1e-6);
  EXPECT_NEAR(empty.swing.time, 1.5707963 / 1.5 + 1.5 * 15e3 / 34e3, 1e-6);
  EXPECT_EQ(empty.back.energy, empty.swing.energy);
  EXPECT_EQ(empty.back.time, empty.swing.time);
  // The payload as a point over the cavity's centre, 3-5 m from the axis.
  const DigCycle loaded = cycle(500.0);
  const double radius =
      std::sqrt((loaded.swing.energy - empty.swing.energy) / (0.5 * 500.0 * 1.5 * 1.5));
  const LinkPositions clear = link_positions(bare_, path_.poses.back().joints);
  EXPECT_GT(radius, std::min(clear.tip.x(), clear.bucket_pin.x()));
  EXPECT_LT(radius, std::max(clear.tip.x(), clear.bucket_pin.x()));
  EXPECT_EQ(loaded.back.energy, empty.back.energy) << "without the payload";
}

TEST_F(Cycle, SwingThatDoesNotReachItsRateAcceleratesHalfTheWay) {
  const DigCycle dug = cycle(0.0, by_angle(0.5));
  EXPECT_NEAR(dug.swing.energy, 34e3 * 0.5 / 2.0, 1e-6);  // torque times half the angle
  EXPECT_NEAR(dug.swing.time, 2.0 * std::sqrt(0.5 * 15e3 / 34e3), 1e-9);
  EXPECT_EQ(cycle(0.0, by_angle(0.0)).swing.energy, 0.0);
  EXPECT_EQ(cycle(0.0, by_angle(0.0)).swing.time, 0.0);
}

TEST_F(Cycle, AKeptLoadIsNeitherSwungNorDumped) {
  CycleOptions keeps;
  keeps.keeps_load = true;
  const DigCycle kept = cycle(100.0, keeps), whole = cycle(100.0);
  EXPECT_EQ(kept.swing.energy + kept.dump.energy + kept.back.energy, 0.0);
  EXPECT_EQ(kept.dump.time, 0.0);
  EXPECT_EQ(kept.dig.energy, whole.dig.energy);
  EXPECT_LT(kept.lift.energy, whole.lift.energy);
  EXPECT_GT(kept.lift.energy + kept.lower.energy, 0.0);
  EXPECT_LT(kept.total.energy, whole.total.energy);
  EXPECT_LT(kept.total.time, whole.total.time);
}

TEST_F(Cycle, WhatIsCarriedIsLiftedAgain) {
  CycleOptions keeps;
  keeps.keeps_load = true;
  CycleOptions more = keeps;
  more.carried = 200.0;
  const DigCycle without = cycle(100.0, keeps), with = cycle(100.0, more);
  auto lifted = path_.poses.begin();
  while (lifted->phase != DigPhase::lift) ++lifted;
  --lifted;
  const double rise = link_positions(bare_, lifted->joints).bucket_pin.y() -
                      link_positions(bare_, path_.poses.front().joints).bucket_pin.y();
  EXPECT_NEAR(with.dig.energy - without.dig.energy, 200.0 * 9.81 * std::max(0.0, rise), 1.0);
  EXPECT_NEAR(with.lift.energy, cycle(300.0, keeps).lift.energy, 1e-6);
}

TEST_F(Cycle, ABucketThatOnlyDumpsCostsThatPartOfACycle) {
  CycleOptions options = by_angle(1.2);
  options.carried = 300.0;
  const auto dump = dump_of(bare_, path_.poses.back().joints, options);
  ASSERT_TRUE(dump.has_value());
  const DigCycle whole = cycle(300.0, by_angle(1.2));
  EXPECT_GT(dump->energy, whole.swing.energy + whole.dump.energy);
  EXPECT_LT(dump->energy, whole.total.energy);
  EXPECT_LT(dump->time, whole.total.time);
}

TEST_F(Cycle, SwingToTheRightCostsAsMuch) {
  const DigCycle left = cycle(300.0, by_angle(1.2)), right = cycle(300.0, by_angle(-1.2));
  EXPECT_EQ(right.total.energy, left.total.energy);
  EXPECT_EQ(right.total.time, left.total.time);
  EXPECT_NE(cycle(300.0, by_angle(1.3)).total.time, left.total.time);
}

TEST_F(Cycle, SwingKeepsItsOwnAcceleration) {
  bare_.swing->acceleration = 0.4;  // the torque alone gives 2.3 rad/s^2
  EXPECT_NEAR(cycle(0.0, by_angle(0.5)).swing.time, 2.0 * std::sqrt(0.5 / 0.4), 1e-9);
}

TEST_F(Cycle, LinksCountInTheInertia) {
  bare_.links[0] = {1000.0, 0.0, 0.0};  // at the boom pin, 0.14 m from the axis
  const double inertia = 15e3 + 1000.0 * std::pow(bare_.boom_pin.x(), 2);
  EXPECT_NEAR(cycle(0.0).swing.energy, 0.5 * inertia * 1.5 * 1.5, 1e-6);
}

TEST_F(Cycle, DumpIsATrapezoidOfTheBucketsRate) {
  // The scoop leaves the line from pin to tip level, at -180 deg; open, the floor falls by 45 deg.
  const double turn = std::abs(-3.14159265 - (0.78539816 - 3.14159265 + bare_.beta()));
  const double rate = 0.8 * bare_.limits[2].speed;
  const double by_hand = turn / rate + rate / (0.8 * bare_.limits[2].acceleration);
  EXPECT_NEAR(cycle(500.0, to_height(0.0)).dump.time, by_hand, 0.03 * by_hand);
}

TEST_F(Cycle, SwingOverlapsWithTheRestOfTheLiftAndTheWayDown) {
  const DigCycle quick = cycle(500.0, by_angle(0.1));
  EXPECT_NEAR(quick.total.time, 5.0 + quick.lift.time + quick.dump.time + quick.lower.time, 1e-9);
  const DigCycle slow = cycle(500.0, by_angle(3.1));
  const double clear = slow.total.time - 5.0 - slow.swing.time - slow.dump.time - slow.back.time;
  EXPECT_GT(clear, 0.0);
  EXPECT_LT(clear, slow.lift.time);
}

TEST_F(Cycle, IsTheSumOfItsPartsWithIdlePowerAllTheTime) {
  CycleOptions waiting;
  waiting.rest_of_cycle = 4.0;
  const DigCycle all = cycle(500.0, waiting);
  EXPECT_NEAR(all.total.time, cycle(500.0).total.time + 4.0, 1e-12);
  EXPECT_NEAR(all.rest.energy, 5e3 * all.total.time, 1e-6);
  EXPECT_NEAR(all.total.energy,
              20e3 + all.lift.energy + all.swing.energy + all.dump.energy + all.back.energy +
                  all.lower.energy + all.rest.energy,
              1e-6);
}

TEST_F(Cycle, AWeakEngineMakesTheLiftLast) {
  bare_.engine->power = 1e3;
  const DigCycle weak = cycle(500.0);
  EXPECT_DOUBLE_EQ(weak.lift.time, weak.lift.energy / 1e3);
}

/// 12-16 s for a machine of its class in a swing of 90 degrees, practical values 10-17 s
/// (Caterpillar Performance Handbook, ed. 47, p. 7-246).
TEST_F(Cycle, OfTheZx120TakesAsLongAsHandbooksSay) {
  const auto cycle = cycle_of(zx120_, path_of(zx120_), dig_of(600.0));
  ASSERT_TRUE(cycle);
  EXPECT_GT(cycle->total.time, 10.0);
  EXPECT_LT(cycle->total.time, 17.0);
}

TEST_F(Cycle, AMachineThatLacksItsDataIsRefusedByName) {
  EXPECT_EQ(test::error_of([&] { require_cycle(bare_, {}); }), "no error");
  EXPECT_EQ(test::error_of([&] {
              require_cycle(bare_, to_height(9.0));
            }).find("the cycle of machine zx120: the dump height is 9 m, the bucket pin reaches"),
            0U);
  bare_.engine.reset();
  EXPECT_FALSE(cycle_of(bare_, path_, dig_of(500.0)));
  EXPECT_EQ(test::error_of([&] { require_cycle(bare_, {}); }),
            "the cycle of machine zx120: its file lacks engine (power_w, idle_power_w); the goal "
            "energy needs neither");
  bare_.swing.reset();
  EXPECT_NE(test::error_of([&] { require_cycle(bare_, {}); }).find("lacks swing (speed_rad_per_s,"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan
