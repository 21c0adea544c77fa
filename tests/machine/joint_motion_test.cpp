// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/joint_motion.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>

#include "base/yaml.hpp"

#include "support/errors.hpp"
#include "support/motion_check.hpp"

namespace excavplan::test {
namespace {

/// The points as a controller reads them.
Trajectory sent(const Trajectory& motion) {
  Trajectory read = motion;
  const nlohmann::json points = parse_yaml("motion", to_joint_trajectory(motion))["points"];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const nlohmann::json& time = points[i]["time_from_start"];
    read.points[i].time =
        1e-9 * static_cast<double>(time["sec"].get<std::int64_t>() * 1'000'000'000 +
                                   time["nanosec"].get<std::int64_t>());
  }
  return read;
}

TEST(JointMotion, KeepsTheJerkWithTheTimesOfMessages) {
  MotionCase made;
  made.machine = load_machine(find_data_file("machines/zx120.json"));
  made.way.poses = {{DigPhase::approach, {-0.3, 1.5, 0.0, 0.0}},
                    {DigPhase::approach, {0.1, 1.0, 0.5, 0.0}}};
  made.options.max_jerk = 1.0;
  for (const double rate : {100.0, 300.0, 333.0, 499.0}) {
    made.options.rate = rate;
    const Trajectory motion = sent(time_way(made.machine, made.way, made.options));
    EXPECT_LE(used_between(made, motion, quintic).jerk, 1.0 + 1e-4) << rate;
    EXPECT_LE(used_between(made, motion, cubic).jerk, 1.0 + 1e-4) << rate;
  }
}

TEST(JointMotion, MessagesStateThePlanInAComment) {
  Trajectory trajectory;
  trajectory.points.resize(1);
  const nlohmann::json before = parse_yaml("motion", to_joint_trajectory(trajectory));
  trajectory.plan = PlanStamp{"0123456789abcdef"};
  EXPECT_NE(to_joint_trajectory(trajectory).find("\n# plan: {\"id\":\"0123456789abcdef\""),
            std::string::npos);
  EXPECT_EQ(parse_yaml("motion", to_joint_trajectory(trajectory)), before);
  EXPECT_NE(to_joint_commands(trajectory).find("\n# plan: {"), std::string::npos);
}

TEST(JointMotion, RoundsTimesToNanoseconds) {
  Trajectory trajectory;
  trajectory.points.resize(2);
  trajectory.points[1].time = 4.35;  // the double is below it
  EXPECT_EQ(joint_motion(trajectory).points[1].time_ns, 4'350'000'000);
  EXPECT_NE(to_joint_trajectory(trajectory).find("{sec: 4, nanosec: 350000000}"),
            std::string::npos);
  trajectory.points[1].time = 1e300;
  EXPECT_NE(error_of([&] { joint_motion(trajectory); }).find("trajectory: time [s]"),
            std::string::npos);
}

}  // namespace
}  // namespace excavplan::test
