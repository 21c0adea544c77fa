// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/motion.hpp>
#include <excavplan/planning/cycle_motion.hpp>
#include <excavplan/planning/plan_motion.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "planning/surroundings.hpp"
#include "support/machine_file.hpp"
#include "support/motion_cases.hpp"

/// @file
/// What the way of a cycle passes over. Its clearance is found here from the points of the timed
/// motion, at points 2 cm apart all over the front, above ground in closed form.

namespace excavplan::test {
namespace {

using Eigen::Vector2d;

using Ground = std::function<double(double x, double y)>;

Terrain terrain_of(const Ground& ground) {
  Terrain terrain = level_swing_ground(zx120());
  HeightMap& map = terrain.bank;
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      map.z(row, col) = ground(map.x(col), map.y(row));
    }
  }
  return terrain;
}

/// That of the ground within a box, else level.
Ground box_on_ground(double x_min, double y_min, double x_max, double y_max, double height) {
  return [=](double x, double y) {
    return x >= x_min && x <= x_max && y >= y_min && y <= y_max ? height : 0.0;
  };
}

FrontJoints front_at(double boom, double arm, double bucket, double swing = 0.0) {
  return {boom, arm, bucket, swing};
}

/// Of arm and bucket above the ground, and of the boom ahead of the tracks.
double clearance(const Machine& machine, const FrontJoints& joints, const Ground& ground) {
  constexpr double apart = 0.02;
  const LinkPositions at = link_positions(machine, joints.head<3>());
  const Vector2d ahead(std::cos(joints[3]), std::sin(joints[3])), aside(-ahead.y(), ahead.x());
  const double half = 0.5 * machine.bucket.width_outside;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector2d& from, const Vector2d& to, double nearest) {
    const double parts = std::ceil((to - from).norm() / apart);
    for (double i = 0.0; i <= parts; ++i) {
      const Vector2d on = from + i / parts * (to - from);
      if (on.x() < nearest) continue;
      for (double y = -half; y <= half; y += apart) {
        const Vector2d place = on.x() * ahead + y * aside;
        least = std::min(least, on.y() - ground(place.x(), place.y()));
      }
    }
  };
  look(machine.boom_pin, at.arm_pin, 2.3);
  look(at.arm_pin, at.bucket_pin, -100.0);
  const auto& profile = machine.bucket.profile;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    look(bucket_point(at, profile[i]), bucket_point(at, profile[(i + 1) % profile.size()]), -100.0);
  }
  return least;
}

/// The least of these phases of a motion.
double clearance(const Machine& machine, const Trajectory& motion, const Ground& ground,
                 DigPhase first, DigPhase last) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < motion.points.size(); i += 2) {
    const TrajectoryPoint& point = motion.points[i];
    if (point.phase < first || point.phase > last) continue;
    FrontJoints joints;
    joints << point.joints, point.swing.angle;
    least = std::min(least, clearance(machine, joints, ground));
  }
  return least;
}

CycleWayOptions whole_cycle(double dump_height = 3.0) {
  CycleWayOptions options;
  options.whole_cycle = true;
  options.cycle.dump_height = dump_height;
  return options;
}

std::variant<Way, BlockedWay> cycle_over(const Terrain& ground, double dump_height = 3.0) {
  return way_of_cycle(zx120(), ground, fixed_path(), {{}, 500.0}, whole_cycle(dump_height));
}

bool has(const Way& way, const std::string& code) {
  return std::any_of(way.warnings.begin(), way.warnings.end(), [&](const Warning& warning) {
    return code_text(warning.code) == code && warning.ends_trust;
  });
}

double level_at(double, double) { return 0.0; }

/// A berm of 1.5 m at (3, 3), on the way of a swing of 90 degrees at 5 m.
TEST(Surroundings, ABermBesideTheDigIsPassedAbove) {
  const Ground berm = box_on_ground(2.5, 2.5, 3.5, 3.5, 1.5);
  const Way straight = std::get<Way>(cycle_over(level_swing_ground(zx120()), 2.0));
  const Way over = std::get<Way>(cycle_over(terrain_of(berm), 2.0));
  const auto least = [&](const Way& way, const Ground& ground) {
    return clearance(zx120(), time_way(zx120(), way), ground, DigPhase::swing, DigPhase::back);
  };
  EXPECT_LT(least(straight, berm), -0.3) << "on the way";
  EXPECT_GT(least(straight, level_at), 0.09);
  EXPECT_GT(least(over, berm), 0.0);
  EXPECT_TRUE(over.warnings.empty());
}

TEST(Surroundings, AWallThatIsTooHighBlocksTheSwing) {
  const auto blocked = cycle_over(terrain_of(box_on_ground(2.0, 2.5, 4.0, 3.5, 9.0)));
  const auto* stop = std::get_if<BlockedWay>(&blocked);
  ASSERT_NE(stop, nullptr);
  EXPECT_EQ(stop->phase, DigPhase::swing);
  EXPECT_NEAR(stop->place.y(), 2.5, 0.2);
}

/// A post of one cell anywhere that a swing passes is passed above, or blocks.
TEST(Surroundings, NoPostOfOneCellPassesBetween) {
  Random random(7);
  int above = 0, near = 0;
  const Trajectory straight =
      time_way(zx120(), std::get<Way>(cycle_over(level_swing_ground(zx120()), 2.0)));
  for (int i = 0; i < 12; ++i) {
    const double angle = random.uniform(0.25, 1.5), radius = random.uniform(3.0, 6.0);
    const HeightMap map = level_swing_ground(zx120()).bank;
    const double cell = map.cell_size;
    const auto corner = [&](double x, double origin) {
      return origin + cell * std::floor((x - origin) / cell);
    };
    const double x = corner(radius * std::cos(angle), map.origin.x());
    const double y = corner(radius * std::sin(angle), map.origin.y());
    const Ground post = box_on_ground(x, y, x + cell, y + cell, 1.6);
    const auto laid = cycle_over(terrain_of(post), 2.0);
    if (const Way* way = std::get_if<Way>(&laid)) {
      const Trajectory motion = time_way(zx120(), *way);
      EXPECT_GT(clearance(zx120(), motion, post, DigPhase::swing, DigPhase::back), -0.02)
          << x << ' ' << y;
      ++above;
    }
    near += clearance(zx120(), straight, post, DigPhase::swing, DigPhase::back) < 0.0 ? 1 : 0;
  }
  EXPECT_GT(above, 7);
  EXPECT_GT(near, 2);
}

/// The bucket stands 0.5 m deep in a trench that a scan shows, at a swing of 0.9.
TEST(Surroundings, TheWayMayBeginInATrench) {
  const double swing = 0.9;
  const auto trench = [&](double half) {
    return [=](double x, double y) {
      const double along = x * std::cos(swing) + y * std::sin(swing);
      const double aside = y * std::cos(swing) - x * std::sin(swing);
      return along > 3.5 && along < 7.0 && std::abs(aside) < half ? -0.55 : 0.0;
    };
  };
  const auto joints = std::get<JointAngles>(inverse_kinematics(zx120(), {5.0, -0.5, 0.1}));
  CycleWayOptions options;
  options.start.emplace();
  *options.start << joints, swing;
  const auto begun = [&](const Ground& ground) {
    return way_of_cycle(zx120(), terrain_of(ground), fixed_path(), {{}, 500.0}, options);
  };
  for (const double half : {0.37, 0.5}) {
    const auto laid = begun(trench(half));
    ASSERT_TRUE(std::holds_alternative<Way>(laid)) << std::get<BlockedWay>(laid).message;
    const Way& way = std::get<Way>(laid);
    EXPECT_LT(way.poses[1].joints[0], joints[0]);
    EXPECT_EQ(way.poses[1].joints[3], swing);
  }
  const auto level_ground = begun(level_at);
  const auto* stop = std::get_if<BlockedWay>(&level_ground);
  ASSERT_NE(stop, nullptr);
  EXPECT_NE(stop->message.find("in the ground at x = "), std::string::npos) << stop->message;
}

/// From a trench the machine must not be lifted into what stands right beside the bucket.
TEST(Surroundings, APostAboveTheBucketBlocksTheWayOffTheGround) {
  const auto joints = std::get<JointAngles>(inverse_kinematics(zx120(), {5.0, 0.0, 0.1}));
  CycleWayOptions options;
  options.start.emplace();
  *options.start << joints, 0.9;
  const LinkPositions at = link_positions(zx120(), joints);
  const double x = 0.5 * (at.arm_pin.x() + at.bucket_pin.x());
  const double under_arm = 0.5 * (at.arm_pin.y() + at.bucket_pin.y());
  const Vector2d place = x * Vector2d(std::cos(0.9), std::sin(0.9));
  const auto laid = way_of_cycle(
      zx120(),
      terrain_of(box_on_ground(place.x(), place.y(), place.x() + 0.05, place.y() + 0.05, 9.0)),
      fixed_path(), {{}, 500.0}, options);
  EXPECT_GT(under_arm, 1.0);
  EXPECT_TRUE(std::holds_alternative<BlockedWay>(laid));
}

double attitude(const WayPose& pose) { return pose.joints.head<3>().sum(); }

/// Of the poses of the swing from the end of the lift.
double most_tipped(const Way& way) {
  double from = 0.0, most = 0.0;
  for (const WayPose& pose : way.poses) {
    if (pose.phase == DigPhase::lift) from = attitude(pose);
    if (pose.phase == DigPhase::swing) most = std::max(most, std::abs(attitude(pose) - from));
  }
  return most;
}

TEST(Surroundings, AFullBucketKeepsItsAttitudeOnADetour) {
  const Terrain windrows = terrain_of([](double x, double y) {
    return x > 2.4 && std::abs(y) > 0.8 && std::abs(y) < 1.6 ? 1.8 : 0.0;
  });
  const Way way = std::get<Way>(cycle_over(windrows, 2.0));
  double highest = 0.0;
  for (const WayPose& pose : way.poses) {
    if (pose.phase == DigPhase::swing) highest = std::max(highest, -pose.joints[0]);
  }
  const Way straight = std::get<Way>(cycle_over(level_swing_ground(zx120()), 2.0));
  EXPECT_GT(highest, -straight.poses.back().joints[0] + 0.2) << "a detour";
  EXPECT_LT(most_tipped(way), 1e-9);
  EXPECT_FALSE(has(way, "payload_tips"));
}

/// A wall that the front does not reach, beside or behind the tracks.
TEST(Surroundings, TheTailKeepsClearOfWhatStandsBesideTheTracks) {
  const auto with_wall = [](double x, double y, double height) {
    Terrain ground = level_swing_ground(zx120());
    ground.obstacles = ground.bank.z * std::nan("");
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < ground.bank.z.rows(); ++row) {
        const double dx = ground.bank.x(col) - x, dy = ground.bank.y(row) - y;
        if (std::hypot(dx, dy) < 0.15) ground.obstacles(row, col) = height;
      }
    }
    return ground;
  };
  const auto blocked = [&](double x, double y, double height) {
    const auto laid = cycle_over(with_wall(x, y, height), 2.0);
    const auto* stop = std::get_if<BlockedWay>(&laid);
    EXPECT_TRUE(stop == nullptr || stop->message.find("obstacle") != std::string::npos);
    return stop != nullptr;
  };
  EXPECT_TRUE(blocked(-0.3, -1.8, 1.5)) << "the tail comes there on a swing to the left";
  EXPECT_TRUE(blocked(-1.7, -1.45, 1.5));
  EXPECT_FALSE(blocked(-1.7, -1.45, 0.6)) << "as low as the tracks";
  EXPECT_FALSE(blocked(-0.3, -2.6, 3.0));
  EXPECT_FALSE(blocked(-1.9, 1.75, 3.0)) << "the tail goes away from there";
}

TEST(Surroundings, WhatStandsInTheSwingIsPassedAboveOrBlocks) {
  const auto with_post = [](double height) {
    Terrain ground = level_swing_ground(zx120());
    ground.obstacles = ground.bank.z * std::nan("");
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < ground.bank.z.rows(); ++row) {
        if (std::hypot(ground.bank.x(col) - 3.5, ground.bank.y(row) - 3.5) > 0.2) continue;
        ground.obstacles(row, col) = height;
        ground.bank.z(row, col) = std::nan("");
      }
    }
    return ground;
  };
  const auto over = cycle_over(with_post(1.5), 2.0);
  ASSERT_TRUE(std::holds_alternative<Way>(over));
  EXPECT_TRUE(std::get<Way>(over).warnings.empty());
  EXPECT_TRUE(std::holds_alternative<BlockedWay>(cycle_over(with_post(9.0), 2.0)));
}

/// Where the bucket dumps after a swing of 90 degrees, 3 m high.
TEST(Surroundings, WhatStandsHigherThanTheDumpHeightAtTheDumpPlaceIsTold) {
  const SoilKind loam = load_soil(find_data_file("soils/loam.json"));
  const DigPlan plan = plan_dig(zx120(), loam, GroundDensity{40.0});
  ASSERT_TRUE(plan.dig);
  const auto standing = [&](double y_from, double y_to, double counted, double seen) {
    Terrain ground = level_swing_ground(zx120());
    ground.obstacles = ground.obstacle_returns = ground.bank.z * std::nan("");
    for (Eigen::Index col = 0; col < ground.bank.z.cols(); ++col) {
      for (Eigen::Index row = 0; row < ground.bank.z.rows(); ++row) {
        const double x = ground.bank.x(col), y = ground.bank.y(row);
        if (std::abs(x) > 1.2 || y < y_from || y > y_to) continue;
        ground.obstacles(row, col) = counted;
        ground.obstacle_returns(row, col) = seen;
        ground.bank.z(row, col) = std::nan("");
      }
    }
    return check_dump_place(zx120(), ground, plan);
  };
  const auto wall = standing(4.0, 9.0, 4.5, 3.6);
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->code, WarningCode::obstacle_at_dump);
  EXPECT_NE(
      wall->message.find("3.6 m high by its highest return and counted up to 4.5 m, above the "
                         "dump height of 3.0 m"),
      std::string::npos)
      << wall->message;
  EXPECT_FALSE(standing(4.0, 9.0, 3.4, 2.6)) << "a truck";
  EXPECT_FALSE(standing(-9.0, -4.0, 4.5, 3.6)) << "on the other side";
  EXPECT_FALSE(check_dump_place(zx120(), level_swing_ground(zx120()), plan));
}

TEST(Surroundings, ABucketThatCannotKeepItsAttitudeIsToldOf) {
  Machine stiff = zx120();
  const DigPath path = fixed_path();
  stiff.limits[2].upper = path.poses.back().joints[2] + 0.05;
  const auto laid =
      way_of_cycle(stiff, level_swing_ground(stiff), path, {{}, 500.0}, whole_cycle());
  const Way& way = std::get<Way>(laid);
  EXPECT_GT(most_tipped(way), 0.18);
  EXPECT_TRUE(has(way, "payload_tips"));
}

Ground undercarriage(const Machine& machine) {
  const double half = 0.5 * machine.undercarriage_width(), length = machine.track_front;
  return box_on_ground(-length, -half, length, half, 0.5 * length);
}

TEST(Surroundings, TheUndercarriageDoesNotTurnWithTheSwing) {
  CycleWayOptions options;
  const auto from = [&](const FrontJoints& start) {
    options.start = start;
    return way_of_cycle(zx120(), level_swing_ground(zx120()), fixed_path(), {{}, 0.0}, options);
  };
  const Ground core = box_on_ground(-1.65, -1.0, 1.65, 1.0, 0.9);
  FrontJoints folded;
  double deepest = 0.0;
  for (double boom = -1.0; boom < 0.3; boom += 0.05) {
    for (double bucket = -0.5; bucket < 2.4; bucket += 0.1) {
      const FrontJoints joints = front_at(boom, 2.65, bucket);
      const double height = clearance(zx120(), joints, core);
      if (height >= deepest || clearance(zx120(), joints, level_at) < 0.0) continue;
      deepest = height;
      folded = joints;
    }
  }
  ASSERT_LT(deepest, -0.15);
  const auto inside = from(folded);
  const auto* stop = std::get_if<BlockedWay>(&inside);
  ASSERT_NE(stop, nullptr);
  EXPECT_NE(stop->message.find("in the undercarriage at x = "), std::string::npos) << stop->message;
  // Beside a track and past its corner, which is farther from the axis.
  FrontJoints beside;
  bool found = false;
  for (double boom = -1.0; boom < 0.0 && !found; boom += 0.02) {
    for (double bucket = 0.0; bucket < 2.4 && !found; bucket += 0.1) {
      beside = front_at(boom, 2.58, bucket, 1.57);
      found = clearance(zx120(), beside, undercarriage(zx120())) > 0.12 &&
              clearance(zx120(), front_at(boom, 2.58, bucket, 0.7), undercarriage(zx120())) < -0.1;
    }
  }
  ASSERT_TRUE(found);
  const auto around = from(beside);
  ASSERT_TRUE(std::holds_alternative<Way>(around)) << std::get<BlockedWay>(around).message;
  const Trajectory motion = time_way(zx120(), std::get<Way>(around));
  EXPECT_GT(
      clearance(zx120(), motion, undercarriage(zx120()), DigPhase::approach, DigPhase::approach),
      0.0);
}

TEST(Surroundings, TheTracksAreAsWideAsTheMachineFileSays) {
  Machine machine = zx120();
  EXPECT_EQ(machine.undercarriage_width(), 2.6);
  machine.track_width.reset();
  EXPECT_NEAR(machine.undercarriage_width(), 2.6, 1e-12) << "the usual proportion";
  machine.track_front = 0.9;
  EXPECT_NEAR(machine.undercarriage_width(), 1.3, 1e-12);
}

TEST(Surroundings, UnseenGroundOnTheWayEndsTrust) {
  const Way way = std::get<Way>(cycle_over(level_planning_ground(zx120())));
  ASSERT_TRUE(has(way, "unseen_way"));
  EXPECT_NE(way.warnings[0].message.find(" m2 of the ground that the front passes over"),
            std::string::npos)
      << way.warnings[0].message;
  EXPECT_TRUE(std::get<Way>(cycle_over(level_swing_ground(zx120()))).warnings.empty());
  Terrain elsewhere = level_swing_ground(zx120());
  elsewhere.bank.z.topRows(elsewhere.bank.z.rows() / 2 - 20) = std::nan("");
  EXPECT_TRUE(std::get<Way>(cycle_over(elsewhere)).warnings.empty()) << "to the right";
}

/// A stake beside the trench stands in a cell that finer ones of the dig know, and lower, in part.
TEST(Surroundings, GroundThatFineCellsKnowInPartDoesNotBecomeLower) {
  const Machine& machine = zx120();
  const auto joints = inverse_kinematics(machine, {5.2, 1.0, 0.3});
  FrontJoints from = front_at(0.0, 0.0, 0.0, -0.3), to = from;
  from.head<3>() = to.head<3>() = std::get<JointAngles>(joints);
  to[3] = 0.3;
  const auto is_blocked = [&](double height) {
    HeightMap ground = level_swing_ground(machine).bank;
    const auto col = static_cast<Eigen::Index>((5.2 - ground.origin.x()) / ground.cell_size);
    const Eigen::Index row = ground.z.rows() / 2;
    ground.z(row, col) = height;
    Surroundings around(machine, undisturbed(ground));
    HeightMap after;
    after.cell_size = 0.25 * ground.cell_size;
    after.origin = ground.origin +
                   ground.cell_size * Vector2d(static_cast<double>(col), static_cast<double>(row));
    after.z = Eigen::ArrayXXd::Constant(4, 4, -0.4);
    after.z.col(3) = std::nan("");
    around.replace(after);
    return around.obstacle(from, to).has_value();
  };
  EXPECT_FALSE(is_blocked(0.0));
  EXPECT_TRUE(is_blocked(2.0));
}

TEST(Surroundings, TheSwingBeginsOverTheGroundThatTheDigLeaves) {
  const Ground heap = box_on_ground(3.0, 0.6, 7.0, 1.2, 1.6);
  DigLoad load = {{}, 500.0};
  const auto swung = [&] {
    const auto laid =
        way_of_cycle(zx120(), level_swing_ground(zx120()), fixed_path(), load, whole_cycle(2.0));
    return clearance(zx120(), time_way(zx120(), std::get<Way>(laid)), heap, DigPhase::swing,
                     DigPhase::back);
  };
  EXPECT_LT(swung(), -0.3);
  load.ground_after = level_planning_ground(zx120()).bank;
  for (Eigen::Index col = 0; col < load.ground_after.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < load.ground_after.z.rows(); ++row) {
      load.ground_after.z(row, col) = heap(load.ground_after.x(col), load.ground_after.y(row));
    }
  }
  EXPECT_GT(swung(), 0.0);
}

}  // namespace
}  // namespace excavplan::test
