// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/controller/robot_node.hpp>

#include <any>
#include <map>

#include <gtest/gtest.h>

#include "support/errors.hpp"

namespace excavplan::test {
namespace {

/// Those of a node: given ones, and the names that were asked for.
struct GivenParameters {
  std::map<std::string, std::any> given;
  std::vector<std::string> asked = {};

  template <typename Value>
  Value value(const std::string& name, const Value& usual) {
    asked.push_back(name);
    const auto found = given.find(name);
    return found == given.end() ? usual : std::any_cast<Value>(found->second);
  }
};

DigCycleSettings settings_by(std::map<std::string, std::any> given) {
  GivenParameters parameters = {std::move(given)};
  return settings_of(parameters).session;
}

TEST(RobotNode, ParametersAreTheSettings) {
  const DigCycleSettings usual = settings_by({});
  EXPECT_EQ(usual.machine.name, "zx120");
  EXPECT_EQ(usual.scans, DigCycleSettings{}.scans);
  EXPECT_EQ(usual.machine.robot_joints[0].name, "boom_joint");
  const std::vector<std::string> names = {"b", "a", "k", ""};
  const DigCycleSettings settings = settings_by({{"scans", 3},
                                                 {"joint_names", names},
                                                 {"rate_hz", 50.0},
                                                 {"density_percent", 20.0},
                                                 {"site_frame", std::string("base")},
                                                 {"whole_cycle", true}});
  EXPECT_EQ(settings.scans, 3U);
  EXPECT_EQ(settings.machine.robot_joints[2].name, "k");
  EXPECT_EQ(settings.motion.rate, 50.0);
  EXPECT_EQ(settings.density.percent, 20.0);
  EXPECT_EQ(settings.site_frame, "base");
  EXPECT_TRUE(settings.whole_cycle);
  EXPECT_EQ(settings_by({{"scans", -1}}).scans, 0U);
  EXPECT_EQ(error_of([] {
              settings_by({{"joint_names", std::vector<std::string>{"a"}}});
            }),
            "parameter joint_names: has 1 names, must have 4: boom, arm, bucket, swing");
}

TEST(RobotNode, ATimeForTheSearchNeedsASearch) {
  EXPECT_EQ(settings_by({{"search", true}, {"search_seconds", 3.0}}).search_seconds, 3.0);
  EXPECT_EQ(error_of([] {
              settings_by({{"search_seconds", 3.0}});
            }),
            "parameter search_seconds: has no effect without search");
}

TEST(RobotNode, SendsNoMotionThatIsNotSafe) {
  CyclePlan plan;
  plan.motion = {{"b"}, {{0, {1.0}, {0.0}, {0.0}}}};
  for (const bool trustworthy : {true, false}) {
    for (const bool known : {true, false}) {
      plan.trustworthy = trustworthy;
      plan.posture_known = known;
      const JointMotion sent = safe_motion(plan);
      EXPECT_EQ(sent.names, plan.motion.names);
      EXPECT_EQ(sent.points.size(), trustworthy && known ? 1U : 0U);
    }
  }
}

TEST(RobotNode, AClockBeforeItBeganIsNoTime) {
  EXPECT_FALSE(known_time(0));
  EXPECT_EQ(known_time(5), 5);
}

struct PointMessage {
  std::vector<double> positions, velocities, accelerations;
  std::int64_t time_from_start = 0;
};
struct TrajectoryMessage {
  std::vector<std::string> joint_names;
  std::vector<PointMessage> points;
};

TEST(RobotNode, TheTrajectoryIsThatOfThePlan) {
  const JointMotion motion = {
      {"b", "a"},
      {{0, {1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}}, {3'333'333, {7.0, 8.0}, {9.0, 10.0}, {}}}};
  const auto set = [](std::int64_t& time, std::int64_t ns) { time = ns; };
  const auto message = joint_trajectory_message<TrajectoryMessage>(motion, set);
  EXPECT_EQ(message.joint_names, motion.names);
  ASSERT_EQ(message.points.size(), 2U);
  EXPECT_EQ(message.points[0].accelerations, motion.points[0].accelerations);
  EXPECT_EQ(message.points[1].positions, motion.points[1].positions);
  EXPECT_EQ(message.points[1].velocities, motion.points[1].velocities);
  EXPECT_EQ(message.points[1].time_from_start, 3'333'333);
}

}  // namespace
}  // namespace excavplan::test
