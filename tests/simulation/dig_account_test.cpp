// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/dig_account.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/random.hpp"
#include "machine/plane.hpp"
#include "simulation/section_simulator.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using test::zx120;
using Cause = Stall::Cause;

/// 10 t that stand on edges 1 m before and behind their centre, with a front that weighs nothing
/// and joints of any torque.
Machine see_saw() {
  Machine machine = zx120();
  for (JointLimits& limits : machine.limits) limits.torque = 1e12;
  for (LinkMass& link : machine.links) link.mass = 0.0;
  machine.body = Body{10e3, {0.0, 1.0}, -1.0, 1.0, 0.5};
  return machine;
}
constexpr double weight = 10e3 * gravity;

const JointAngles posture(-0.3, 1.5, 0.5);

DigStep step_under(const Machine& machine, const Vector2d& point, const Vector2d& soil,
                   double payload = 0.0, const JointAngles& joints = posture) {
  const LinkPositions at = link_positions(machine, joints);
  DigStep step;
  step.phase = DigPhase::drag;
  step.joints = joints;
  step.turn = JointAngles(0.01, 0.01, 0.01);
  step.by_soil = torque_against_force(machine, at, point, soil);
  step.by_payload = torque_against_force(machine, at, at.tip, {0.0, -payload});
  step.by_links = torque_against_link_weight(machine, at);
  step.force = soil - Vector2d(0.0, payload);
  return step;
}

std::optional<Stall> stall_of(const Machine& machine, const DigStep& step) {
  const DigPath path{};
  const DigOptions options{};
  DigAccount account(machine, path, options);
  account.travel(0.25);
  const bool stalls = account.stalls(step);
  EXPECT_EQ(stalls, account.result.stall.has_value());
  return account.result.stall;
}

/// What ends the dig at a force of the soil at (5, z), and how much of it.
struct Limit {
  Cause cause;
  Vector2d direction;
  double z;
  double force;   ///< at which the machine gives way [N]
  double needed;  ///< [N m] or [N]
};

// Closed forms: levers of 6 and 4 m about the edges, a weight of 1 m about either; a force along
// the ground turns the machine by its depth.
TEST(Footing, GivesWayAtTheClosedFormInEveryDirection) {
  const Vector2d up(0, 1), down(0, -1), forward(1, 0), back(-1, 0);
  for (const Limit& limit : {Limit{Cause::front_lifts, up, 0.0, weight / 6, weight},
                             Limit{Cause::rear_lifts, down, 0.0, weight / 4, weight},
                             Limit{Cause::slides, forward, 0.0, weight / 2, weight / 2},
                             Limit{Cause::slides, back, 0.0, weight / 2, weight / 2},
                             Limit{Cause::front_lifts, forward, -3.0, weight / 3, weight},
                             Limit{Cause::rear_lifts, back, -3.0, weight / 3, weight},
                             Limit{Cause::rear_lifts, forward, 3.0, weight / 3, weight},
                             Limit{Cause::front_lifts, back, 3.0, weight / 3, weight}}) {
    const auto at = [&](double share) {
      return stall_of(see_saw(),
                      step_under(see_saw(), {5.0, limit.z}, share * limit.force * limit.direction));
    };
    EXPECT_FALSE(at(0.999)) << name(limit.cause);
    const auto stall = at(1.001);
    ASSERT_TRUE(stall) << name(limit.cause);
    EXPECT_EQ(stall->cause, limit.cause);
    EXPECT_NEAR(stall->needed, 1.001 * limit.needed, 1e-6 * weight);
    EXPECT_NEAR(stall->held, limit.needed, 1e-6 * weight);
    EXPECT_EQ(stall->phase, DigPhase::drag);
    EXPECT_EQ(stall->travelled, 0.25);
    EXPECT_EQ(stall->torque, 0.0);
  }
}

TEST(Footing, WhatPressesTheMachineDownHoldsItFromSliding) {
  const auto slides = [](double along, double up) {
    Machine wide = see_saw();
    wide.body->rear_edge = -100.0;
    wide.body->front_edge = 100.0;
    return stall_of(wide, step_under(wide, {5.0, 0.0}, {along, up})).has_value();
  };
  const double up = 0.2 * weight;  // of the soil: 0.8 of the weight stays on the tracks, or 1.2
  EXPECT_FALSE(slides(0.399 * weight, up));
  EXPECT_TRUE(slides(0.401 * weight, up));
  EXPECT_FALSE(slides(-0.599 * weight, -up));
  EXPECT_TRUE(slides(-0.601 * weight, -up));
}

TEST(Footing, APayloadHoldsTheFrontDownAndLiftsTheRear) {
  const Machine machine = see_saw();
  const double tip = link_positions(machine, posture).tip.x();
  const double most = weight / (tip - 1.0);  // of payload
  EXPECT_FALSE(stall_of(machine, step_under(machine, {5, 0}, {0, 0}, 0.999 * most)));
  const auto stall = stall_of(machine, step_under(machine, {5, 0}, {0, 0}, 1.001 * most));
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->cause, Cause::rear_lifts);
  const double lift = (weight + 0.5 * most * (tip + 1.0)) / 6.0;
  EXPECT_FALSE(stall_of(machine, step_under(machine, {5, 0}, {0, 0.999 * lift}, 0.5 * most)));
  EXPECT_TRUE(stall_of(machine, step_under(machine, {5, 0}, {0, 1.001 * lift}, 0.5 * most)));
}

/// Moment about (edge, 0) of the weight of body and links, each at its own centre.
double moment_of_weight(const Machine& machine, const JointAngles& joints, double edge) {
  const LinkPositions at = link_positions(machine, joints);
  const Vector2d pins[] = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  const double angles[] = {at.phi1, at.phi2, at.phi3};
  double moment = -machine.body->mass * gravity * (machine.body->centre.x() - edge);
  for (std::size_t i = 0; i < 3; ++i) {
    const LinkMass& link = machine.links[i];
    const double x =
        pins[i].x() + link.along * std::cos(angles[i]) - link.across * std::sin(angles[i]);
    moment -= link.mass * gravity * (x - edge);
  }
  return moment;
}

TEST(Footing, IsTheSumOfAllMomentsForAnyForceAndPosture) {
  Machine machine = zx120();
  for (JointLimits& limits : machine.limits) limits.torque = 1e12;
  Random random(5);
  int tipped = 0;
  for (int n = 0; n < 2000; ++n) {
    const JointAngles joints(random.uniform(-0.9, 0.5), random.uniform(0.6, 2.5),
                             random.uniform(-0.5, 2.4));
    const LinkPositions at = link_positions(machine, joints);
    const Vector2d point = at.tip + Vector2d(random.uniform(0, 1), random.uniform(0, 1));
    const Vector2d soil(random.uniform(-5e4, 5e4), random.uniform(-5e4, 5e4));
    const double payload = random.uniform(0.0, 1e4);
    const auto about = [&](double edge) {
      const Vector2d foot(edge, 0.0);
      return moment_of_weight(machine, joints, edge) + cross(point - foot, soil) -
             payload * (at.tip.x() - edge);
    };
    const auto stall = stall_of(machine, step_under(machine, point, soil, payload, joints));
    const bool front = about(machine.body->rear_edge) > 0.0;
    const bool rear = about(machine.body->front_edge) < 0.0;
    EXPECT_EQ(stall && stall->cause == Cause::front_lifts, front);
    EXPECT_EQ(stall && stall->cause == Cause::rear_lifts, rear && !front);
    if (!front) continue;
    ++tipped;
    EXPECT_NEAR(stall->needed - stall->held, about(machine.body->rear_edge), 1e-3);
    EXPECT_NEAR(stall->held, -moment_of_weight(machine, joints, machine.body->rear_edge), 1e-3);
  }
  EXPECT_GT(tipped, 300);
}

// 34 kN upwards at x = 5.8 m: 34 (5.8 + 1.44) = 246 kN m against the weight of 12.7 t.
TEST(Footing, OfTheZx120GivesWayToTheForceOfDenseLoam) {
  const auto joints = std::get<JointAngles>(inverse_kinematics(zx120(), {5.8, 0.0, 0.785}));
  const auto stall = stall_of(zx120(), step_under(zx120(), {5.8, 0.0}, {0.0, 34e3}, 0.0, joints));
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->cause, Cause::front_lifts);
  EXPECT_NEAR(stall->needed, 246.16e3, 10.0);
  EXPECT_GT(stall->held, 165e3);
  EXPECT_LT(stall->held, 240e3);
}

TEST(Footing, OfAMachineWithoutABodyHoldsEverything) {
  Machine machine = see_saw();
  machine.body.reset();
  EXPECT_FALSE(stall_of(machine, step_under(machine, {5.0, -2.0}, {1e6, 1e6})));
}

TEST(Footing, AJointThatLacksTorqueIsNamedFirst) {
  Machine machine = see_saw();
  machine.limits[1].torque = 1e3;
  const auto stall = stall_of(machine, step_under(machine, {5.0, 0.0}, {0.0, weight}));
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->cause, Cause::torque);
  EXPECT_EQ(stall->joint, Joint::arm);
  EXPECT_EQ(stall->needed, std::abs(stall->torque));
  EXPECT_EQ(stall->held, 1e3);
}

TEST(Footing, IsSaidInPlainWords) {
  const auto text = [](Cause cause) {
    return describe(Stall{DigPhase::drag, Joint::boom, 0.5, 0.0, cause, 12345.0, 10000.0});
  };
  EXPECT_EQ(text(Cause::front_lifts),
            "the machine's front lifts in the phase drag after 0.500 m: the moment of soil and "
            "payload about its rear edge is 12.3 kN m, its weight holds 10.0 kN m");
  EXPECT_EQ(text(Cause::rear_lifts),
            "the machine's rear lifts in the phase drag after 0.500 m: the moment of soil and "
            "payload about its front edge is 12.3 kN m, its weight holds 10.0 kN m");
  EXPECT_EQ(text(Cause::slides),
            "the machine slides on its tracks in the phase drag after 0.500 m: the soil pulls with "
            "12.3 kN, the ground holds 10.0 kN");
  EXPECT_EQ(describe(Stall{DigPhase::scoop, Joint::arm, 0.5, -12345.0}),
            "the arm stalls in the phase scoop after 0.500 m: the required torque is 12.3 kN m");
}

// ---- in a dig -----------------------------------------------------------------------------------

/// Both simulators.
class Simulators : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<SoilSimulator> make(const Machine& machine, double density) const {
    const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
    if (GetParam()) return std::make_unique<SectionSimulator>(machine, loam, density);
    return std::make_unique<HeightMapSimulator>(machine, loam, density);
  }
  DigResult dig(const Machine& machine, double density) const {
    return make(machine, density)->dig(ground_, path_);
  }

  const Terrain ground_ = level_planning_ground(zx120());
  const DigPath path_ = std::get<DigPath>(
      make_dig_path(zx120(), paper_fixed_path(), 6.05, boom_plane_profile(ground_)));
};

INSTANTIATE_TEST_SUITE_P(BuiltIn, Simulators, testing::Bool(), [](const auto& tested) {
  return tested.param ? "section" : "height_map";
});

TEST_P(Simulators, EndADigThatWouldLiftTheMachine) {
  const DigResult lifted = dig(zx120(), 95.0);
  ASSERT_TRUE(lifted.stall);
  EXPECT_EQ(lifted.stall->cause, Cause::front_lifts);
  EXPECT_EQ(lifted.stall->phase, DigPhase::penetrate);
  EXPECT_NEAR(lifted.soil.solids_after, lifted.soil.solids_before,
              1e-9 * lifted.soil.solids_before);
  Machine heavy = zx120();
  heavy.body->mass *= 4.0;
  EXPECT_FALSE(dig(heavy, 95.0).stall);
}

TEST_P(Simulators, EndADigThatWouldDragTheMachine) {
  Machine on_ice = zx120();
  on_ice.body->track_friction = 0.02;
  const DigResult dragged = dig(on_ice, 40.0);
  ASSERT_TRUE(dragged.stall);
  EXPECT_EQ(dragged.stall->cause, Cause::slides);
  EXPECT_GT(dragged.stall->needed, dragged.stall->held);
}

TEST_P(Simulators, StateTheTorquesOfEveryStretch) {
  const DigResult result = dig(zx120(), 40.0);
  ASSERT_EQ(result.torques.size(), path_.poses.size() - 1);
  double digging = 0.0, lifting = 0.0;
  for (std::size_t i = 0; i < result.torques.size(); ++i) {
    const DigPose& to = path_.poses[i + 1];
    const JointAngles work = result.torques[i].cwiseProduct(to.joints - path_.poses[i].joints);
    (to.phase == DigPhase::lift ? lifting : digging) += work.cwiseMax(0.0).sum();
  }
  EXPECT_NEAR(digging, result.energy.total, 1e-9 * digging);
  EXPECT_NEAR(lifting, result.energy.lift, 1e-9 * lifting);
}

// docs/formats.md#force-history: one row per step of penetrate, drag and scoop.
TEST_P(Simulators, RecordTheForcesOfEveryStepInTheGroundAndOfNoneAbove) {
  DigOptions options;
  options.history = true;
  const DigResult result = make(zx120(), 40.0)->dig(ground_, path_, options);
  std::vector<std::string> in_ground, recorded;
  for (std::size_t i = 1; i < path_.poses.size(); ++i) {
    if (path_.poses[i].phase != DigPhase::lift) in_ground.push_back(name(path_.poses[i].phase));
  }
  for (const ForceSample& sample : result.history) recorded.push_back(name(sample.phase));
  ASSERT_LT(in_ground.size(), path_.poses.size() - 1) << "the path ends with a lift";
  EXPECT_EQ(recorded, in_ground);
}

// Above the corner pressure of the pumps the soil slows the machine.
TEST_P(Simulators, MakeADigTakeLongerInDenserSoil) {
  Machine held_down = test::zx120_held_down();
  double last = 0.0;
  for (const double density : {60.0, 75.0, 90.0}) {
    const auto outcome = evaluate_dig(held_down, *make(held_down, density), ground_,
                                      paper_fixed_path(), StartRule(6.05));
    const double duration = std::get<PlannedDig>(outcome).duration;
    EXPECT_GT(duration, 1.01 * last) << density;
    last = duration;
  }
  const double unloaded = time_dig_path(held_down, path_).dig_duration();
  EXPECT_GT(last, 1.05 * unloaded);
  held_down.engine.reset();
  const auto tireless =
      evaluate_dig(held_down, *make(held_down, 90.0), ground_, paper_fixed_path(), StartRule(6.05));
  EXPECT_EQ(std::get<PlannedDig>(tireless).duration, unloaded);
}

TEST_P(Simulators, StateTheTorquesAsFarAsTheMachineCame) {
  const DigResult lifted = dig(zx120(), 95.0);
  ASSERT_TRUE(lifted.stall);
  double travelled = 0.0;
  for (std::size_t i = 0; i < lifted.torques.size(); ++i) {
    const BucketPose &from = path_.poses[i].bucket, &to = path_.poses[i + 1].bucket;
    travelled += std::hypot(to.x - from.x, to.z - from.z);
  }
  EXPECT_NEAR(travelled, lifted.stall->travelled, 1e-12);
}

}  // namespace
}  // namespace excavplan
