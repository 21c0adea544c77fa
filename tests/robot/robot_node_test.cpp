// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/goal_words.hpp>
#include <excavplan/robot/robot_node.hpp>

#include <any>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "support/errors.hpp"
#include "support/kit_folder.hpp"

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
  const std::vector<std::string> names = {"b", "a", "k", "s"};
  const DigCycleSettings settings = settings_by({{"scans", 3},
                                                 {"joint_names", names},
                                                 {"rate_hz", 50.0},
                                                 {"density_percent", 20.0},
                                                 {"site_frame", std::string("base")},
                                                 {"whole_cycle", true},
                                                 {"level_ground", true}});
  EXPECT_EQ(settings.scans, 3U);
  EXPECT_EQ(settings.machine.robot_joints[2].name, "k");
  EXPECT_EQ(settings.motion.rate, 50.0);
  EXPECT_EQ(settings.density.percent, 20.0);
  EXPECT_EQ(settings.site_frame, "base");
  EXPECT_TRUE(settings.whole_cycle);
  EXPECT_TRUE(settings.level_ground && !usual.level_ground);
  EXPECT_EQ(error_of([] {
              settings_by({{"joint_names", std::vector<std::string>{"a"}}});
            }),
            "parameter joint_names: has 1 names, must have 4: boom, arm, bucket, swing");
}

TEST(RobotNode, ParametersOfAJob) {
  const auto settings_by = [](std::map<std::string, std::any> given) {
    GivenParameters parameters = {std::move(given)};
    return job_settings_of(parameters);
  };
  EXPECT_EQ(error_of([&] { settings_by({}); }),
            "parameter job: is missing: folder of a job of plan-site");
  const JobSessionSettings settings = settings_by({{"job", std::string("trench")},
                                                   {"scans", 3},
                                                   {"site_frame", std::string("map")},
                                                   {"machine_in_view", true},
                                                   {"joint_age_seconds", 2.0},
                                                   {"rate_hz", 50.0}});
  EXPECT_EQ(settings.folder, "trench");
  EXPECT_EQ(settings.scans, 3U);
  EXPECT_EQ(settings.site_frame, "map");
  EXPECT_TRUE(settings.machine_in_view);
  EXPECT_EQ(settings.oldest_joints, 2.0);
  EXPECT_EQ(settings.motion.rate, 50.0);
  EXPECT_NE(error_of([&] {
              settings_by({{"job", std::string("trench")}, {"rate_hz", 5.0}});
            }).find("parameter rate_hz: "),
            std::string::npos);
}

TEST(RobotNode, ReadsTheSurroundingsInTheFrameOfTheScans) {
  const TemporaryFolder folder;
  std::string points;
  for (double x = 0.0; x < 1.0; x += 0.02) {
    for (double y = 0.0; y < 1.0; y += 0.02) {
      points += std::to_string(x) + " " + std::to_string(y) + " 0.5\n";
    }
  }
  const std::string cloud = folder.write("around.xyz", points);
  const std::string frame = folder.write("frame.txt", "1 0 0 -4\n0 1 0 3\n0 0 1 0.25\n0 0 0 1\n");
  EXPECT_FALSE(settings_by({}).surroundings.has_value());
  const DigCycleSettings settings = settings_by({{"surroundings", cloud}, {"frame_file", frame}});
  const HeightMap& ground = settings.surroundings->bank;
  const auto at = [&](double x, double y) {
    return ground.z(static_cast<Eigen::Index>((y - ground.origin.y()) / ground.cell_size),
                    static_cast<Eigen::Index>((x - ground.origin.x()) / ground.cell_size));
  };
  EXPECT_NEAR(at(-3.5, 3.5), 0.75, 1e-6);
  EXPECT_TRUE(std::isnan(at(3.5, 3.5)));
  EXPECT_EQ(error_of([&] {
              settings_by({{"surroundings", cloud}, {"level_ground", true}});
            }),
            "parameter level_ground: not with surroundings, which show whether it is");
  EXPECT_EQ(error_of(
                [&] {
                  settings_by({{"surroundings", folder.file("none.pcd")}});
                },
                ErrorKind::bad_file),
            "parameter surroundings: " + folder.file("none.pcd") +
                ": cannot be opened: No such file or directory");
}

TEST(RobotNode, ATimeForTheSearchNeedsASearch) {
  EXPECT_EQ(settings_by({{"search", true}, {"search_seconds", 3.0}}).search_seconds, 3.0);
  EXPECT_EQ(error_of([] {
              settings_by({{"search_seconds", 3.0}});
            }),
            "parameter search_seconds: has no effect without search");
}

TEST(RobotNode, NamesTheParameterThatIsWrong) {
  const auto error = [](const std::string& name, const std::any& value) {
    return error_of([&] { settings_by({{name, value}}); });
  };
  EXPECT_EQ(error("scans", -1), "parameter scans is -1, must be in 1 .. 100");
  EXPECT_EQ(error("joint_age_seconds", 0.0), "parameter joint_age_seconds is 0, must be above 0");
  const std::vector<std::pair<std::string, double>> numbers = {{"rate_hz", 5.0},
                                                               {"max_jerk", 0.0},
                                                               {"speed_fraction", 2.0},
                                                               {"density_sd_percent", -1.0},
                                                               {"density_percent", 101.0}};
  for (const auto& [name, value] : numbers) {
    const std::string text = error(name, value);
    EXPECT_EQ(text.rfind("parameter " + name + ": ", 0), 0U) << text;
    EXPECT_NE(text.find(" is " + std::to_string(static_cast<int>(value)) + ", must be"),
              std::string::npos)
        << text;
  }
  EXPECT_NE(error("dump_height", 30.0).find("the dump height is 30 m"), std::string::npos);
  EXPECT_NE(error("swing", -9.0).find("the swing from dig to dump (to the right: below 0) is -9"),
            std::string::npos);
  EXPECT_EQ(error("goal", std::string("gold")),
            "the goal 'gold' is none of cycle, energy, time, priced:WATT");
  EXPECT_NE(error("machine", std::string("zx9")).find("'zx9' is neither"), std::string::npos);
  EXPECT_EQ(error("machine", std::string("zx200")),
            "no density law of zx200 in loam is shipped: make one with machine-kit or "
            "calibrate-density, or name one");
}

TEST(RobotNode, AWholeCycleNeedsASwing) {
  const std::vector<std::string> names = {"b", "a", "k", ""};
  EXPECT_EQ(error_of([&] {
              settings_by({{"whole_cycle", true}, {"joint_names", names}});
            }),
            "parameter whole_cycle: needs a name of the swing joint in joint_names");
}

TEST(RobotNode, PlansForAnyGoal) {
  const DigObjective usual = settings_by({}).plan.search.objective;
  EXPECT_EQ(usual.goal, DigObjective::Goal::cycle);
  EXPECT_EQ(usual.dump_height, CycleOptions{}.dump_height);
  const DigObjective energy =
      settings_by({{"goal", std::string("energy")}, {"swing", 1.0}, {"dump_height", 2.0}})
          .plan.search.objective;
  EXPECT_EQ(energy.goal, DigObjective::Goal::energy);
  EXPECT_EQ(energy.swing, 1.0);
  EXPECT_EQ(energy.dump_height, 2.0);
  const DigObjective priced =
      settings_by({{"goal", std::string("priced:500")}, {"search", true}, {"min_fill", 0.3}})
          .plan.search.objective;
  EXPECT_EQ(priced.time_price, 500.0);
  EXPECT_EQ(priced.min_fill, 0.3);
  for (const char* goal : {"priced", "priced:", "priced:5x", "cycle:1"}) {
    EXPECT_NE(error_of([&] { objective_named(goal); }), "no error") << goal;
  }
}

TEST(RobotNode, AMachineOfOnesOwnHasTheFilesOfItsKit) {
  const KitFolder folder;
  DigObjective low = DigObjective::Goal::cycle;
  low.dump_height = 2.5;
  folder.add_library(low);
  for (const std::string& word : {folder.machine(), folder.kit()}) {
    const DigCycleSettings settings = settings_by({{"machine", word}});
    EXPECT_EQ(settings.machine.name, "digger");
    EXPECT_EQ(settings.law.name, "digger-loam");
    EXPECT_EQ(settings.plan.library->machine, "digger");
    EXPECT_EQ(settings.plan.search.objective.dump_height, 2.5);
    EXPECT_TRUE(DigCycleSession(settings).plan().plan.dig);
  }
  const std::string library = folder.kit() + "/libraries/digger-loam-cycle.json";
  EXPECT_EQ(settings_by({{"machine", folder.machine()}, {"library", library}, {"dump_height", 2.5}})
                .plan.library->machine,
            "digger");
  EXPECT_NE(error_of([&] {
              settings_by({{"machine", folder.machine()}, {"dump_height", 2.0}});
            }).find("dump_height_m"),
            std::string::npos);
}

TEST(RobotNode, AMachineThatDoesNotReachTheUsualHeightDumpsLower) {
  const DigCycleSettings settings = settings_by({{"machine", std::string("generic-mini")},
                                                 {"law", std::string("zx120-loam")},
                                                 {"search", true}});
  EXPECT_LT(settings.plan.search.objective.dump_height, CycleOptions{}.dump_height);
  ASSERT_EQ(settings.warnings.size(), 1U);
  EXPECT_EQ(settings.warnings[0].code, WarningCode::dump_height_lowered);
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
