// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/machine.hpp>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/kinematics.hpp>
#include <excavplan/planning/plan_motion.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "machine/machine_mass.hpp"
#include "planning/front_load.hpp"
#include "planning/motion_load.hpp"
#include "support/machine_file.hpp"

/// @file
/// A machine that does not stand level: torques, tipping and digs.

namespace excavplan::test {
namespace {

using Eigen::Vector3d;

/// Potential energy of links and payload, their places turned into the level site frame [J].
double potential(const Machine& machine, const FrontJoints& joints, double payload) {
  const LinkPositions at = link_positions(machine, joints.head<3>());
  const auto height = [&](const Eigen::Vector2d& p) {
    const Vector3d place(p.x() * std::cos(joints[3]), p.x() * std::sin(joints[3]), p.y());
    return (machine.attitude.to_site() * place).z();
  };
  double sum = payload * height(bucket_point(at, cavity_centre(machine.bucket)));
  const auto centres = link_centres(machine, at);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    sum += machine.links[i].mass * height(centres[i]);
  }
  return gravity * sum;
}

TEST(Attitude, TurnsAsItsSignsSay) {
  const Vector3d left = Attitude{10.0 * degree, 0.0}.to_site() * Vector3d::UnitY();
  EXPECT_NEAR(left.z(), std::sin(10.0 * degree), 1e-12) << "roll raises the left side";
  const Vector3d ahead = Attitude{0.0, 10.0 * degree}.to_site() * Vector3d::UnitX();
  EXPECT_NEAR(ahead.z(), -std::sin(10.0 * degree), 1e-12) << "pitch lowers the front";
  EXPECT_EQ(Attitude{}.up(), Vector3d::UnitZ());
}

TEST(Attitude, TorquesAreTheSlopesOfThePotentialEnergy) {
  constexpr double step = 1e-5;
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Machine machine =
        with_attitude(zx120(), {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)});
    const FrontJoints joints(random.uniform(-1.0, 0.5), random.uniform(0.6, 2.5),
                             random.uniform(-0.4, 2.0), random.uniform(-3.0, 3.0));
    const double payload = random.uniform(0.0, 800.0);
    const JointAngles torque = FrontLoad(machine, payload).torque(joints.head<3>(), joints[3]);
    for (int j = 0; j < 3; ++j) {
      FrontJoints more = joints, less = joints;
      more[j] += step;
      less[j] -= step;
      const double slope =
          (potential(machine, more, payload) - potential(machine, less, payload)) / (2.0 * step);
      EXPECT_NEAR(torque[j], slope, 1e-3 + 1e-6 * std::abs(slope));
    }
  }
}

// By hand: without a front the centre of the body, 1.15 m high, lies over the edge of a slope of
// atan(distance / height).
TEST(Attitude, TipsWhereThePlumbLineLeavesTheTracks) {
  Machine bare = zx120();
  for (LinkMass& link : bare.links) link.mass = 1e-9;
  for (auto& limits : bare.limits) limits.torque = 1e9;
  bare.swing->torque = 1e9;
  const Body& body = *bare.body;
  const Way way = {{{DigPhase::swing, FrontJoints(-0.3, 1.5, 1.0, 0.0), JointAngles::Zero()}}, {}};
  const double ahead = std::atan((body.front_edge - body.centre.x()) / body.centre.y());
  const double behind = std::atan((body.centre.x() - body.rear_edge) / body.centre.y());
  const double aside = std::atan(0.69 * body.front_edge / body.centre.y());
  for (const auto& [attitude, name] : {std::pair{Attitude{0.0, ahead}, "ahead"},
                                       {Attitude{0.0, -behind}, "behind"},
                                       {Attitude{aside, 0.0}, "right"},
                                       {Attitude{-aside, 0.0}, "left"}}) {
    for (const double share : {0.99, 1.01}) {
      const Attitude steep{share * attitude.roll, share * attitude.pitch};
      const auto warnings = load_warnings(bare, way, steep);
      EXPECT_EQ(!warnings.empty(), share > 1.0) << name << ' ' << share;
      for (const Warning& each : warnings) EXPECT_EQ(each.code, WarningCode::motion_tips);
    }
  }
}

TEST(Attitude, TheSwingMustHoldTheFrontOnASlope) {
  const Way way = {
      {{DigPhase::swing, FrontJoints(-0.3, 1.0, 0.3, 0.0), JointAngles::Zero(), 900.0}}, {}};
  EXPECT_TRUE(load_warnings(zx120(), way).empty());
  Machine weak = with_attitude(zx120(), {8.0 * degree, 0.0});
  weak.swing->torque = 1000.0;
  const auto warnings = load_warnings(weak, way);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, WarningCode::motion_overload);
  EXPECT_NE(warnings[0].message.find("the swing needs"), std::string::npos);
}

/// In sand, which resists by its weight.
DigResult dug_at(const Attitude& attitude, const SimulatorKind& kind = default_simulator()) {
  static const SoilKind sand = load_soil(find_data_file("soils/sand.json"));
  const Machine machine = with_attitude(zx120(), attitude);
  const Terrain level = level_planning_ground(machine);
  const auto path = make_dig_path(machine, paper_fixed_path(), 6.0, [](double) { return 0.0; });
  DigOptions options;
  options.history = true;
  return kind.make(machine, sand, 40.0)->dig(level, std::get<DigPath>(path), options);
}

/// Of soil on the bucket against the drag, the mean [N].
double drag_of(const DigResult& result) {
  double sum = 0.0, count = 0.0;
  for (const ForceSample& at : result.history) {
    if (at.phase != DigPhase::drag) continue;
    sum += at.soil.x();
    count += 1.0;
  }
  return sum / count;
}

TEST(Attitude, PullingSoilUphillTakesMoreThanDownhillInBothSimulators) {
  for (const SimulatorKind& kind : simulator_kinds()) {
    const DigResult level = dug_at({}, kind), front_down = dug_at({0.0, 12.0 * degree}, kind),
                    front_up = dug_at({0.0, -12.0 * degree}, kind);
    ASSERT_FALSE(level.stall || front_down.stall || front_up.stall) << kind.name;
    EXPECT_GT(drag_of(front_down), 1.02 * drag_of(level)) << kind.name;
    EXPECT_LT(drag_of(front_up), 0.98 * drag_of(level)) << kind.name;
  }
}

TEST(Attitude, ASteepSlopeLetsTheMachineSlideOrTip) {
  EXPECT_TRUE(dug_at({0.0, 0.7}).stall);
  EXPECT_TRUE(dug_at({0.0, -0.7}).stall);
  EXPECT_EQ(dug_at({0.7, 0.0}).stall->cause, Stall::Cause::slides);
}

TEST(Attitude, APlanIsOfTheMachineAsItStands) {
  PlanOptions options;
  const DigPlan level = plan_dig(zx120(), loam(), 40.0, options);
  options.attitude = {0.0, 6.0 * degree};
  const DigPlan tilted = plan_dig(zx120(), loam(), 40.0, options);
  ASSERT_TRUE(level.dig && tilted.dig) << tilted.reason;
  EXPECT_TRUE(tilted.trustworthy);
  EXPECT_EQ(level.evaluations, 0);
  EXPECT_GT(tilted.evaluations, 0) << "no figure of the library holds";
  EXPECT_EQ(tilted.attitude.pitch, 6.0 * degree);
  options.attitude = {0.0, 2.0};
  EXPECT_THROW(plan_dig(zx120(), loam(), 40.0, options), Error);
}

}  // namespace
}  // namespace excavplan::test
