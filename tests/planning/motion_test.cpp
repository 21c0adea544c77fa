// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/joint_motion.hpp>
#include <excavplan/machine/motion.hpp>
#include <excavplan/planning/cycle_motion.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/yaml.hpp"

#include "base/non_finite.hpp"
#include "base/random.hpp"
#include "planning/motion_load.hpp"
#include "support/cases.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/motion_cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

const Terrain& level() {
  static const Terrain ground = level_planning_ground(zx120());
  return ground;
}

void expect_kept(const UsedLimits& used) {
  EXPECT_LE(used.most(), 1.0 + 1e-6);
  EXPECT_LE(used.rate, 1.0 + 1e-6);
  EXPECT_LE(used.acceleration, 1.0 + 1e-6);
  EXPECT_LE(used.jerk, 1.0 + 1e-6);
  EXPECT_LE(used.swing_torque, 1.0 + 1e-6);
  EXPECT_LE(used.cylinder_speed, 1.0 + 1e-6);
  EXPECT_LE(used.flow, 1.0 + 1e-6);
  EXPECT_LE(used.power, 1.0 + 1e-6);
  EXPECT_LE(used.beyond, 1e-9);
}

TEST(Motion, KeepsEveryLimitBetweenItsPointsOverRandomDigs) {
  const int tried = tried_of(1200);
  int timed = 0;
  for_cases(
      [&](Random& random) {
        const auto made = any_motion(random);
        if (!made) return;
        ++timed;
        const Trajectory motion = time_way(made->machine, made->way, made->options);
        expect_kept(used_between(*made, motion, cubic));
        expect_kept(used_between(*made, motion, quintic));
      },
      tried);
  EXPECT_GT(timed, tried / 6);
}

/// Rounding put a cell at the limit of the power above it, and the machine stopped there for ever:
/// one of 10^4 digs.
TEST(Motion, GoesOnWhereTheDriveAloneLimitsTheSpeed) {
  Random random(16, 50728);
  const auto made = any_motion(random);
  ASSERT_TRUE(made);
  const std::vector<JointAngles> torques(made->path.poses.size() - 1, made->torque);
  const TrajectoryOptions options{made->options.speed_fraction, made->options.corner_tolerance};
  const double points = time_dig_path(made->machine, made->path, options, torques).duration();
  const Trajectory motion = time_way(made->machine, way_of(made->path, torques), made->options);
  EXPECT_NEAR(motion.duration() / points, 1.0, 0.2);
}

FrontJoints front(double boom, double arm, double bucket, double swing = 0.0) {
  return {boom, arm, bucket, swing};
}

Way straight(const FrontJoints& from, const FrontJoints& to) {
  return {{{DigPhase::approach, from, JointAngles::Zero()},
           {DigPhase::approach, to, JointAngles::Zero()}}};
}

// One joint alone is a trapezoid, two steps of smoothing longer, and up to one to the next point.
TEST(Motion, OfOneJointIsTheTextbookTrapezoid) {
  MotionOptions options;
  options.speed_fraction = 1.0;
  const double v = zx120().limits[2].speed, a = zx120().limits[2].acceleration;
  for (const double turn : {0.05, 0.3, 2.0}) {
    const Trajectory motion =
        time_way(zx120(), straight(front(-0.3, 1.5, 0.0), front(-0.3, 1.5, turn)), options);
    const double expected = turn > v * v / a ? turn / v + v / a : 2.0 * std::sqrt(turn / a);
    EXPECT_GE(motion.duration(), expected);
    EXPECT_LE(motion.duration(), 1.001 * expected + 0.03);
  }
  const Way swing = straight(front(-0.3, 1.5, 0.0), front(-0.3, 1.5, 0.0, 1.0));
  const double inertia = inertia_of(zx120(), {-0.3, 1.5, 0.0}, 0.0).value;
  EXPECT_NEAR(time_way(zx120(), swing, options).duration(),
              2.0 * std::sqrt(inertia / zx120().swing->torque), 0.035);
  Machine slow = zx120();
  slow.swing->acceleration = 0.2;
  EXPECT_NEAR(time_way(slow, swing, options).duration(), 2.0 * std::sqrt(1.0 / 0.2), 0.035);
}

/// A motion of one pose to another and what it uses.
UsedLimits used_by(const Machine& machine, const Way& way, double* duration = nullptr) {
  MotionCase made;
  made.machine = machine;
  made.way = way;
  made.options.speed_fraction = 1.0;
  const Trajectory motion = time_way(machine, way, made.options);
  if (duration) *duration = motion.duration();
  return used_between(made, motion, quintic);
}

// At 2 rad/s^2 until that takes all of the power P, then with the torque P / w to its rate.
TEST(Motion, SwingAloneKeepsThePowerOfTheEngine) {
  Machine machine = zx120();
  machine.swing->torque = 1e6;
  machine.swing->acceleration = 2.0;
  machine.engine->power = 30e3;
  double duration = 0.0;
  const UsedLimits used =
      used_by(machine, straight(front(-0.3, 1.5, 0.0), front(-0.3, 1.5, 0.0, 6.0)), &duration);
  EXPECT_LE(used.power, 1.0 + 1e-6);
  EXPECT_GE(used.power, 0.99);
  const double inertia = inertia_of(machine, {-0.3, 1.5, 0.0}, 0.0).value;
  const double rate = machine.swing->speed;
  double way = 0.0, at = 0.0;  // of the begin, by steps
  while (at < rate) {
    at += 1e-4 * std::min(2.0, 30e3 / (inertia * std::max(at, 1e-9)));
    way += 1e-4 * at;
    duration -= 1e-4;
  }
  const double braking = rate / 2.0;
  EXPECT_NEAR(duration, braking + (6.0 - way - 0.5 * rate * braking) / rate, 0.05);
}

TEST(Motion, SwingAndCylindersShareThePower) {
  const Way both = [] {
    Way way = straight(front(0.3, 1.2, 0.5), front(-0.8, 1.2, 0.5, 1.8));
    for (WayPose& pose : way.poses) pose.torque = {-120e3, 0.0, 0.0};
    return way;
  }();
  MotionCase made;
  made.machine = zx120();
  made.way = both;
  made.options.speed_fraction = 1.0;
  const Trajectory motion = time_way(made.machine, both, made.options);
  double most = 0.0, swing = 0.0, boom = 0.0;
  for (std::size_t k = 1; k < motion.points.size(); ++k) {
    const TrajectoryPoint& at = motion.points[k];
    const TurnedInertia turned = inertia_of(made.machine, at.joints, 0.0);
    const double torque =
        turned.value * at.swing.acceleration + turned.slope.dot(at.rates) * at.swing.rate;
    const double of_swing = std::max(0.0, torque * at.swing.rate);
    const double of_boom = std::max(0.0, -120e3 * at.rates[0]);
    most = std::max(most, of_swing + of_boom);
    swing = std::max(swing, of_swing);
    boom = std::max(boom, of_boom);
  }
  const double power = zx120().engine->power;
  EXPECT_LE(most, power * (1.0 + 1e-6));
  EXPECT_GE(most, 0.95 * power);
  EXPECT_GT(swing, 0.1 * power);
  EXPECT_GT(boom, 0.3 * power);
}

// A front that reaches out while it swings slows the swing: the torque is the change of J w.
TEST(Motion, SwingKeepsItsTorqueWhileTheFrontMovesOut) {
  Machine machine = zx120();
  machine.swing->torque = 15e3;
  machine.engine.reset();
  for (const double arm : {0.6, 2.4}) {
    const UsedLimits used =
        used_by(machine, straight(front(-0.3, 3.0 - arm, 0.0), front(-0.3, arm, 0.0, 1.5)));
    EXPECT_LE(used.swing_torque, 1.0 + 1e-6);
    EXPECT_GE(used.swing_torque, 0.99);
  }
}

// An arm that goes in and out in waves: the swing of the smoothed motion is checked by itself.
TEST(Motion, SwingKeepsItsTorqueWhileTheFrontMovesInAndOut) {
  Machine machine = zx120();
  machine.swing->torque = 2e3;
  machine.engine.reset();
  MotionCase made;
  made.machine = machine;
  made.options.speed_fraction = 1.0;
  made.options.rate = 500.0;
  made.options.corner_tolerance = 0.01;
  for (int i = 0; i <= 40; ++i) {
    const double swing = 0.05 * i;
    made.way.poses.push_back({DigPhase::approach,
                              front(-0.3, 1.5 + 0.15 * std::sin(10.0 * swing), 0.0, swing),
                              JointAngles::Zero()});
  }
  const Trajectory motion = time_way(machine, made.way, made.options);
  const double used = used_between(made, motion, quintic).swing_torque;
  EXPECT_LE(used, 1.0 + 1e-6);
  EXPECT_GE(used, 0.99);
}

TEST(Motion, BeginsAndEndsAtRestWhereItsWayDoesAtTheRate) {
  const Way way = straight(front(-0.3, 1.5, 0.0), front(0.1, 1.0, 0.5, -0.4));
  MotionOptions options;
  options.rate = 50.0;
  const Trajectory motion = time_way(zx120(), way, options);
  const auto at = [&](std::size_t point, std::size_t derivative) {
    FrontJoints all;
    for (Eigen::Index j = 0; j < 4; ++j) {
      all[j] = state_of(motion.points[point], j)[derivative];
    }
    return all;
  };
  const std::size_t last = motion.points.size() - 1;
  EXPECT_EQ(at(0, 0), way.poses.front().joints);
  EXPECT_LT((at(last, 0) - way.poses.back().joints).norm(), 1e-12);
  for (const std::size_t end : {std::size_t{0}, last}) {
    EXPECT_EQ(at(end, 1).norm(), 0.0);
    EXPECT_EQ(at(end, 2).norm(), 0.0);
  }
  for (std::size_t i = 0; i <= last; ++i) {
    EXPECT_NEAR(motion.points[i].time, 0.02 * static_cast<double>(i), 1e-12);
  }
  EXPECT_EQ(motion.robot_joints[3].name, "swing_joint");
}

/// Distance of a point from a line of tips [m].
double distance_from(const std::vector<BucketPose>& line, const BucketPose& point) {
  double least = 1e9;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d from(line[i - 1].x, line[i - 1].z), to(line[i].x, line[i].z);
    const Eigen::Vector2d at(point.x, point.z), along = to - from;
    const double share = std::clamp((at - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (at - from - share * along).norm());
  }
  return least;
}

TEST(Motion, StaysOnThePathOfTheDigAlsoAtALowRateOrJerk) {
  const DigPath path = fixed_path();
  std::vector<BucketPose> line;
  for (const auto* poses : {&path.approach, &path.poses}) {
    for (const DigPose& pose : *poses) line.push_back(pose.bucket);
  }
  const double infinite = std::numeric_limits<double>::infinity();
  for (const auto& [rate, jerk] :
       {std::pair{100.0, infinite}, {10.0, infinite}, {100.0, 5.0}, {250.0, 1.0}}) {
    MotionOptions options;
    options.rate = rate;
    options.max_jerk = jerk;
    double most = 0.0;
    for (const TrajectoryPoint& point : time_way(zx120(), way_of(path), options).points) {
      most = std::max(most, distance_from(line, point.bucket));
    }
    EXPECT_LT(most, options.corner_tolerance + 0.004) << rate << " Hz, " << jerk << " rad/s^3";
  }
}

TEST(Motion, IsHardlySlowerThanTheTrajectoryOfThePlan) {
  const DigPath path = fixed_path();
  const double motion = time_way(zx120(), way_of(path)).duration();
  EXPECT_NEAR(motion, time_dig_path(zx120(), path).duration(), 0.03 * motion);
}

TEST(Motion, RefusesWhatNoControllerCanRun) {
  const Way good = straight(front(-0.3, 1.5, 0.0), front(0.1, 1.0, 0.5));
  const auto complaint = [&](const std::function<void(Way&, MotionOptions&, Machine&)>& spoil) {
    Way way = good;
    MotionOptions options;
    Machine machine = zx120();
    spoil(way, options, machine);
    return error_of([&] { time_way(machine, way, options); });
  };
  for (const double rate : {0.0, 9.9, 501.0, 1e9, nan}) {
    EXPECT_NE(complaint([&](Way&, MotionOptions& options, Machine&) {
                options.rate = rate;
              }).find("MotionOptions::rate [1/s] is"),
              std::string::npos);
  }
  EXPECT_EQ(complaint([](Way&, MotionOptions& options, Machine&) { options.max_jerk = 0.0; }),
            "MotionOptions::max_jerk is 0, must be at least 0.1 rad/s^3");
  EXPECT_EQ(complaint([](Way& way, MotionOptions&, Machine&) {
              way.poses[1].joints[1] = 3.0;
            }).rfind("pose 1 of the way: arm [rad] is 3, must be in 0.52", 0),
            0U);
  EXPECT_EQ(complaint([&](Way& way, MotionOptions&, Machine&) {
              way.poses[0].joints[0] = nan;
            }).rfind("pose 0 of the way: boom [rad] is nan", 0),
            0U);
  EXPECT_EQ(complaint([](Way& way, MotionOptions&, Machine&) { way.poses.resize(1); }),
            "the way has fewer than 2 poses that differ");
  EXPECT_EQ(complaint([](Way& way, MotionOptions&, Machine& machine) {
              way.poses[1].joints[3] = 1.0;
              machine.swing.reset();
            }),
            "the way swings, but the file of machine zx120 has no swing");
  EXPECT_EQ(
      complaint([](Way& way, MotionOptions&, Machine&) { way.poses[0].phase = DigPhase::lift; }),
      "pose 1 of the way: its phase is before the last one's");
}

CycleWayOptions cycle_options(const FrontJoints& start, double swing = 1.2) {
  CycleWayOptions options;
  options.start = start;
  options.whole_cycle = true;
  options.cycle.swing = swing;
  options.cycle.dump_height = 3.0;
  return options;
}

/// The way of the whole cycle around the paper's fixed path.
std::variant<Way, BlockedWay> cycle_from(const FrontJoints& start, const Terrain& ground) {
  return way_of_cycle(zx120(), ground, fixed_path(), {{}, 500.0}, cycle_options(start));
}

/// Swings of its poses in a phase, all or the extreme one.
std::vector<double> swings_in(const Way& way, DigPhase phase) {
  std::vector<double> swings;
  for (const WayPose& pose : way.poses) {
    if (pose.phase == phase) swings.push_back(pose.joints[3]);
  }
  return swings;
}

TEST(CycleWay, DoesNotDumpIntoAHeap) {
  Terrain heap = level();
  for (Eigen::Index col = 0; col < heap.bank.z.cols(); ++col) {
    if (heap.bank.x(col) > 2.5) heap.bank.z.col(col) = 0.2;
  }
  CycleWayOptions options = cycle_options(front(-0.5, 1.5, 0.5), 0.0);
  options.start.reset();
  options.cycle.dump_height = 0.0;
  const auto laid = way_of_cycle(zx120(), heap, fixed_path(), {{}, 500.0}, options);
  const auto* stop = std::get_if<BlockedWay>(&laid);
  ASSERT_NE(stop, nullptr);
  EXPECT_EQ(stop->phase, DigPhase::dump);
  EXPECT_NE(stop->message.find("where it dumps"), std::string::npos) << stop->message;
}

TEST(CycleWay, DumpsOnEitherSide) {
  for (const double swing : {-1.4, 0.7}) {
    const Way way = std::get<Way>(way_of_cycle(zx120(), level(), fixed_path(), {{}, 500.0},
                                               cycle_options(front(-0.5, 1.5, 0.5), swing)));
    for (const double at : swings_in(way, DigPhase::dump)) EXPECT_EQ(at, swing);
    EXPECT_EQ(way.poses.back().joints[3], 0.0);
  }
}

// An encoder that counts turns: 6.1 rad is 0.18 rad to the right of the dig, not a turn to its
// left.
TEST(CycleWay, GoesToTheNearestTurnOfASwingThatTurnsRound) {
  const double turn = 6.283185307179586;
  for (const auto& [start, ahead] : {std::pair{6.1, turn},
                                     {6.4, turn},
                                     {-13.0, -2.0 * turn},
                                     {3.0, 0.0},
                                     {-100.0, -16.0 * turn}}) {
    const Way way = std::get<Way>(way_of_cycle(zx120(), level(), fixed_path(), {{}, 500.0},
                                               cycle_options(front(-0.5, 1.5, 0.5, start))));
    EXPECT_EQ(way.poses.front().joints[3], start);
    for (const double at : swings_in(way, DigPhase::drag)) EXPECT_NEAR(at, ahead, 1e-9);
    for (const double at : swings_in(way, DigPhase::dump)) EXPECT_NEAR(at, ahead + 1.2, 1e-9);
    const Trajectory motion = time_way(zx120(), way);
    EXPECT_EQ(motion.points.front().swing.angle, start);
  }
}

TEST(CycleWay, KeepsTheRangeOfTheSwing) {
  Machine machine = zx120();
  machine.swing->lower = -1.0;
  machine.swing->upper = 1.0;
  const auto complaint = [&](const CycleWayOptions& options) {
    return error_of([&] { way_of_cycle(machine, level(), fixed_path(), {{}, 500.0}, options); });
  };
  EXPECT_EQ(complaint(cycle_options(front(-0.5, 1.5, 0.5))),
            "cycle: swing [rad] is 1.2, must be in -1 .. 1");
  EXPECT_EQ(complaint(cycle_options(front(-0.5, 1.5, 0.5, 1.1), 0.5)),
            "joints at the start: swing [rad] is 1.1, must be in -1 .. 1");
  EXPECT_EQ(complaint(cycle_options(front(-0.5, 1.5, 0.5, 0.9), -0.5)), "no error");
  EXPECT_EQ(error_of([&] {
              time_way(machine, straight(front(-0.3, 1.5, 0.0), front(-0.3, 1.5, 0.0, 1.3)));
            }),
            "pose 1 of the way: swing [rad] is 1.3, must be in -1 .. 1");
}

std::vector<std::string> codes_of(const Machine& machine, double payload) {
  const Way way = std::get<Way>(way_of_cycle(machine, level(), fixed_path(), {{}, payload},
                                             cycle_options(front(-0.5, 1.5, 0.5), 1.5)));
  std::vector<std::string> codes;
  for (const Warning& warning : load_warnings(machine, way)) {
    EXPECT_TRUE(warning.ends_trust);
    codes.push_back(code_text(warning.code));
  }
  return codes;
}

TEST(CycleWay, WarnsOfWhatTheMachineCannotHold) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(codes_of(zx120(), 500.0), Words{});
  EXPECT_EQ(codes_of(zx120(), 12000.0), Words({"motion_overload", "motion_tips"}));
  Machine weak = zx120();
  weak.limits[0].torque *= 0.1;
  EXPECT_EQ(codes_of(weak, 500.0), Words({"motion_overload"}));
  Machine light = zx120();
  light.body->mass *= 0.1;
  EXPECT_EQ(codes_of(light, 500.0), Words({"motion_tips"}));
}

TEST(CycleWay, AllShippedMachinesHoldAFullBucketToEitherSide) {
  for (const char* name : {"zx120", "zx200", "generic-20t", "generic-mini"}) {
    const Machine machine = shipped_machine(name);
    const double size = machine.full_length() / zx120().full_length();
    DigParameters dig = paper_fixed_path();
    dig.penetration_length *= size;
    dig.drag_length *= size;
    const auto path = make_dig_path(machine, dig, 6.0 * size, [](double) { return 0.0; });
    for (const double swing : {-1.57, 0.0, 1.57}) {
      CycleWayOptions options;
      options.whole_cycle = true;
      options.cycle.swing = swing;
      options.cycle.dump_height = 0.45 * machine.full_length();
      const auto laid =
          way_of_cycle(machine, level_planning_ground(machine), std::get<DigPath>(path),
                       {{}, 1800.0 * heaped_capacity(machine)}, options);
      EXPECT_TRUE(load_warnings(machine, std::get<Way>(laid)).empty()) << name << ' ' << swing;
    }
  }
}

// By hand: at 1.5 rad the edge is 0.69 of 1.44 m away, and the bucket's load some 6.5 m.
TEST(CycleWay, TipsWhereTheMomentsSay) {
  Machine bare = zx120();
  for (LinkMass& link : bare.links) link.mass = 0.0;
  bare.body->centre.x() = 0.0;
  Way way = {{{DigPhase::swing, front(-0.3, 1.5, 1.0, 1.5707963267948966), JointAngles::Zero()}}};
  const LinkPositions at = link_positions(bare, {-0.3, 1.5, 1.0});
  const double reach = bucket_point(at, centroid(bare.bucket.profile)).x();
  const double edge = 0.69 * bare.body->front_edge;
  const double most = bare.body->mass * edge / (reach - edge);
  way.poses[0].payload = 0.999 * most;
  for (auto& limits : bare.limits) limits.torque = 1e9;
  EXPECT_TRUE(load_warnings(bare, way).empty());
  way.poses[0].payload = 1.001 * most;
  EXPECT_EQ(load_warnings(bare, way).at(0).code, WarningCode::motion_tips);
}

TEST(CycleWay, GoesFromThePresentJointsOverTheCycleBackAboveTheCut) {
  const FrontJoints start = front(-0.5, 1.5, 0.5, 0.8);
  const Way way = std::get<Way>(cycle_from(start, level()));
  EXPECT_EQ(way.poses.front().joints, start);
  std::vector<DigPhase> phases;
  for (const WayPose& pose : way.poses) {
    if (phases.empty() || phases.back() != pose.phase) phases.push_back(pose.phase);
  }
  EXPECT_EQ(phases, std::vector<DigPhase>({DigPhase::approach, DigPhase::penetrate, DigPhase::drag,
                                           DigPhase::scoop, DigPhase::lift, DigPhase::swing,
                                           DigPhase::dump, DigPhase::back}));
  const Way dig = way_of(fixed_path());
  EXPECT_LT((way.poses.back().joints - dig.poses.front().joints).norm(), 1e-12);
  const Trajectory motion = time_way(zx120(), way);
  double widest = 0.0;
  for (const TrajectoryPoint& point : motion.points) widest = std::max(widest, point.swing.angle);
  EXPECT_NEAR(widest, 1.2, 1e-9);
}

/// From a bucket on the ground the machine first lifts it.
TEST(CycleWay, RaisesTheBoomWhereTheGroundIsInTheWay) {
  const DigPath path = fixed_path();
  FrontJoints down = front(0.0, 0.0, 0.0, 0.9);
  down.head<3>() = path.poses.front().joints;
  const Way way = std::get<Way>(cycle_from(down, level()));
  EXPECT_LT(way.poses[1].joints[0], down[0]);
  EXPECT_EQ(way.poses[1].joints.tail<3>(), down.tail<3>());
  Terrain wall = level();
  for (Eigen::Index col = 0; col < wall.bank.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < wall.bank.z.rows(); ++row) {
      if (wall.bank.y(row) > 0.6) wall.bank.z(row, col) = 9.0;
    }
  }
  const auto blocked = cycle_from(front(-0.5, 1.5, 0.5), wall);
  const auto* stop = std::get_if<BlockedWay>(&blocked);
  ASSERT_NE(stop, nullptr);
  EXPECT_EQ(stop->phase, DigPhase::swing);
  EXPECT_EQ(stop->message.rfind("swing: the machine would be ", 0), 0U) << stop->message;
}

TEST(CycleWay, RefusesAStartInTheGroundOrBeyondALimit) {
  const auto in_ground = cycle_from(front(0.7, 0.6, 0.0), level());
  const auto* stop = std::get_if<BlockedWay>(&in_ground);
  ASSERT_NE(stop, nullptr);
  EXPECT_NE(stop->message.find("m in the ground at x = "), std::string::npos) << stop->message;
  EXPECT_EQ(error_of([] {
              cycle_from(front(1.0, 1.5, 0.5), level());
            }).rfind("joints at the start: boom [rad] is 1, must be in -1.22", 0),
            0U);
  EXPECT_EQ(error_of([] {
              cycle_from(front(std::nan(""), 1.5, 0.5), level());
            }).rfind("joints at the start: boom [rad] is nan", 0),
            0U);
}

// ---- files --------------------------------------------------------------------------------------

TEST(MotionFiles, JsonIsReadBackExactly) {
  const Trajectory motion =
      time_way(zx120(), std::get<Way>(cycle_from(front(-0.5, 1.5, 0.5), level())));
  const TemporaryFolder folder;
  const std::string text = to_json(motion);
  const Trajectory back = load_trajectory(folder.write("motion.json", text));
  EXPECT_EQ(to_json(back), text);
  EXPECT_EQ(back.robot_joints[2].name, zx120().robot_joints[2].name);
  EXPECT_EQ(back.points[50].accelerations, motion.points[50].accelerations);
  EXPECT_EQ(back.points.back().phase, DigPhase::back);
}

TEST(MotionFiles, CsvAppendsItsColumns) {
  const std::string csv = to_csv(time_way(zx120(), way_of(fixed_path())));
  const std::string head = csv.substr(0, csv.find('\n'));
  const std::string points = to_csv(time_dig_path(zx120(), fixed_path()));
  EXPECT_EQ(head, points.substr(0, points.find('\n')) +
                      ",boom_rad_per_s2,arm_rad_per_s2,bucket_rad_per_s2,swing_rad,"
                      "swing_rad_per_s,swing_rad_per_s2");
}

/// The numbers of a point in the order of the messages.
std::vector<double> in_order(const Trajectory& motion, std::size_t point, std::size_t derivative) {
  std::vector<double> numbers;
  for (Eigen::Index j = 0; j < 4; ++j) {
    numbers.push_back(state_of(motion.points[point], j)[derivative]);
  }
  return numbers;
}

TEST(MotionFiles, YamlIsTheMessageOfRos) {
  const Trajectory motion =
      time_way(zx120(), straight(front(-0.3, 1.5, 1e-7), front(0.1, 1.0, 0.5, -0.4)));
  const std::string yaml = to_joint_trajectory(motion);
  // YAML 1.1 takes 1e-07 for a text and 0 for an integer.
  EXPECT_NE(yaml.find("positions: [-0.3, 1.5, 1.0e-07, 0.0]"), std::string::npos)
      << yaml.substr(0, 300);
  const nlohmann::json message = parse_yaml("motion", yaml);
  EXPECT_EQ(message["header"]["stamp"]["sec"], 0);
  EXPECT_EQ(message["header"]["frame_id"], "");
  EXPECT_EQ(message["joint_names"],
            nlohmann::json({"boom_joint", "arm_joint", "bucket_joint", "swing_joint"}));
  ASSERT_EQ(message["points"].size(), motion.points.size());
  for (std::size_t i = 0; i < motion.points.size(); ++i) {
    const nlohmann::json& point = message["points"][i];
    EXPECT_EQ(point["positions"].get<std::vector<double>>(), in_order(motion, i, 0));
    EXPECT_EQ(point["velocities"].get<std::vector<double>>(), in_order(motion, i, 1));
    EXPECT_EQ(point["accelerations"].get<std::vector<double>>(), in_order(motion, i, 2));
    const nlohmann::json& time = point["time_from_start"];
    EXPECT_EQ(time["sec"].get<long>() * 100 + time["nanosec"].get<long>() / 10000000,
              static_cast<long>(i));
  }
}

TEST(MotionFiles, MessagesAreInTheAnglesOfTheRobot) {
  Machine robot = zx120();
  robot.robot_joints = {{{"b", -1.0, 0.25}, {"a", 1.0, -0.5}, {"k"}, {"s", -1.0}}};
  const Way way = straight(front(-0.3, 1.5, 0.0), front(0.1, 1.0, 0.5, -0.4));
  const Trajectory motion = time_way(robot, way);
  EXPECT_EQ(to_csv(motion), to_csv(time_way(zx120(), way)));
  const TemporaryFolder folder;
  const JointMotion sent =
      joint_motion(load_trajectory(folder.write("motion.json", to_json(motion))));
  EXPECT_EQ(sent.names, (std::vector<std::string>{"b", "a", "k", "s"}));
  const std::size_t last = sent.points.size() - 1, middle = last / 2;
  const std::vector<double> begin = {0.25 + 0.3, 2.0, 0.0, 0.0}, end = {0.15, 1.5, 0.5, 0.4};
  const std::vector<double> signs = {-1.0, 1.0, 1.0, -1.0};
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(sent.points[0].positions[j], begin[j], 1e-12);
    EXPECT_NEAR(sent.points[last].positions[j], end[j], 1e-12);
    EXPECT_EQ(sent.points[middle].velocities[j], signs[j] * in_order(motion, middle, 1)[j]);
    EXPECT_EQ(sent.points[middle].accelerations[j], signs[j] * in_order(motion, middle, 2)[j]);
  }
}

TEST(MotionFiles, RobotJointsAreChecked) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json file =
        nlohmann::json::parse(std::ifstream(find_data_file("machines/zx120.json")));
    file["robot_joints"]["arm"][key] = value;
    return error_of([&] { load_machine(folder.write("machine.json", file.dump())); },
                    ErrorKind::bad_file);
  };
  EXPECT_NE(error("sign", 0.5).find("must be -1 or 1"), std::string::npos);
  EXPECT_NE(error("name", "boom_joint").find("of boom"), std::string::npos);
  EXPECT_NE(error("zero_rad", 11.0).find("zero_rad"), std::string::npos);
  EXPECT_EQ(error("zero_rad", 1.0), "no error");
}

TEST(MotionFiles, OfOperaHoldACommandForEachPoint) {
  Machine machine = zx120();
  const Trajectory motion =
      time_way(machine, straight(front(-0.3, 1.5, 0.0), front(0.1, 1.0, 0.5)));
  const std::string all = to_joint_commands(motion);
  std::size_t begin = 0, count = 0;
  for (; begin < all.size(); ++count) {
    const std::size_t end = std::min(all.find("---\n", begin), all.size());
    const nlohmann::json command = parse_yaml("command", all.substr(begin, end - begin));
    EXPECT_EQ(command["joint_name"].size(), 4U);
    EXPECT_EQ(command["control_type"], 0);
    EXPECT_EQ(command["position"].get<std::vector<double>>(), in_order(motion, count, 0));
    EXPECT_EQ(command["velocity"].get<std::vector<double>>(), in_order(motion, count, 1));
    EXPECT_EQ(command["effort"].get<std::vector<double>>(), std::vector<double>(4, 0.0));
    begin = end + 4;
  }
  EXPECT_EQ(count, motion.points.size());
  machine.swing.reset();
  const Trajectory three = time_way(machine, straight(front(-0.3, 1.5, 0.0), front(0.1, 1.0, 0.5)));
  EXPECT_EQ(parse_yaml("motion", to_joint_trajectory(three))["joint_names"],
            nlohmann::json({"boom_joint", "arm_joint", "bucket_joint"}));
}

}  // namespace
}  // namespace excavplan::test
