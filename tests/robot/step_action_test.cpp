// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/step_action.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "job/job_record.hpp"
#include "robot/robot_job.hpp"
#include "site/site_digs.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

/// A node of no middleware.
struct FakeNode {
  FakeNode(RobotJob& of, const JobSessionSettings& settings)
      : robot(of), action(settings, port()) {}

  StepPort port() {
    StepPort port;
    port.take_joints = [] {};
    port.take_requests = [this] { requests(); };
    port.now = [this] { return std::optional(robot.now()); };
    port.step = [this](const std::string& json) { steps.push_back(json); };
    port.trajectory = [this](const JointMotion& motion) { motions.push_back(motion); };
    port.feedback = [this](const StepFeedback& shown) { states.push_back(shown.state); };
    port.end = [this](StepEnd how, const StepAnswer& answer) {
      ends.push_back(how);
      last = answer;
    };
    return port;
  }
  Take take() {
    return [this](const RobotMessage& message) { action.take(message); };
  }
  long long step() const { return nlohmann::json::parse(steps.back())["step"]; }
  /// Of the present step, without payload or energy.
  MotionReport report(bool stalls = false) const { return {step(), {}, {}, stalls, {}}; }
  /// A goal whose step is planned.
  void begin() {
    robot.stand(take());
    states.clear();
    action.begin();
  }

  RobotJob& robot;
  std::vector<std::string> steps, states;
  std::vector<JointMotion> motions;
  std::vector<StepEnd> ends;
  StepAnswer last;
  std::function<void()> requests = [] {};  ///< that come while it plans
  StepAction action;
};

using States = std::vector<std::string>;

TEST(StepAction, DoesOneStepForAGoal) {
  RobotJob robot;
  FakeNode node(robot, robot.settings(2));
  node.begin();
  EXPECT_EQ(node.states, (States{"planning", "driving"}));
  EXPECT_TRUE(node.ends.empty());
  EXPECT_TRUE(node.motions.back().points.empty()) << "the front stays";
  node.action.report(node.report());
  ASSERT_EQ(node.ends, std::vector<StepEnd>{StepEnd::succeeded});
  EXPECT_EQ(node.states, (States{"planning", "driving"}));
  EXPECT_TRUE(node.last.success && node.last.trustworthy && !node.last.finished);
  EXPECT_EQ(node.last.what, "move");
  EXPECT_EQ(node.last.message, "");
  EXPECT_EQ(nlohmann::json::parse(node.last.progress_json)["moves"], 1);

  node.begin();
  EXPECT_GT(node.motions.back().points.size(), 10U);
  node.action.report(node.report(true));
  EXPECT_EQ(node.last.what, "dig");
  EXPECT_EQ(nlohmann::json::parse(node.last.json)["step"], node.last.step);

  node.begin();
  node.action.report(node.report());
  const Points points = robot.points_now();
  robot.scan(node.take(), points);
  EXPECT_EQ(node.ends.size(), 2U);
  robot.scan(node.take(), points);
  EXPECT_EQ(node.states,
            (States{"planning", "driving", "scan 0 of 2", "scan 1 of 2", "scan 2 of 2"}));
  ASSERT_EQ(node.ends.size(), 3U);
  EXPECT_TRUE(node.last.success);
  EXPECT_EQ(node.last.what, "scan");
  EXPECT_EQ(node.action.session().progress().scans, 1);
}

TEST(StepAction, SendsNoMotionWithoutTrust) {
  RobotJob robot;
  FakeNode node(robot, robot.settings());
  node.begin();
  node.action.report(node.report());
  robot.later += 5'000'000'000;  // without joint states
  node.action.begin();
  EXPECT_EQ(node.ends.back(), StepEnd::aborted);
  EXPECT_TRUE(node.motions.back().points.empty());
  EXPECT_EQ(node.motions.back().names.size(), 4U);
  EXPECT_NE(node.last.message.find("posture_unknown: "), std::string::npos) << node.last.message;
  EXPECT_TRUE(has(node.last.warnings, WarningCode::posture_unknown));
  const long long step = node.step();
  node.begin();
  EXPECT_EQ(node.step(), step);
  EXPECT_FALSE(node.motions.back().points.empty());
}

TEST(StepAction, ACancelledStepStaysAsItIs) {
  RobotJob robot;
  FakeNode node(robot, robot.settings());
  node.begin();
  node.action.report(node.report());
  node.begin();
  const long long step = node.step();
  node.action.cancel();
  EXPECT_EQ(node.ends.back(), StepEnd::cancelled);
  EXPECT_TRUE(node.motions.back().points.empty());
  EXPECT_FALSE(node.last.success);
  const std::size_t ended = node.ends.size();
  node.action.cancel();
  EXPECT_EQ(node.ends.size(), ended) << "no goal is active";

  node.begin();
  EXPECT_EQ(node.step(), step);
  EXPECT_FALSE(node.motions.back().points.empty());
  node.action.abandon();
  EXPECT_EQ(node.ends.back(), StepEnd::aborted);
  EXPECT_TRUE(node.motions.back().points.empty());
  node.action.report(node.report());  // it was done all the same
  EXPECT_EQ(node.ends.size(), ended + 1);
  EXPECT_EQ(node.action.session().progress().digs, 1);
}

bool has_points(const JointMotion& motion) { return !motion.points.empty(); }

TEST(StepAction, AGoalThatIsCancelledWhileItPlansSendsNoMotion) {
  RobotJob robot;
  FakeNode node(robot, robot.settings());
  node.begin();
  node.action.report(node.report());
  node.requests = [&] { node.action.cancel(); };
  node.motions.clear();
  node.begin();
  EXPECT_EQ(node.ends.back(), StepEnd::cancelled);
  EXPECT_EQ(node.ends.size(), 2U);
  EXPECT_EQ(node.states, States{"planning"});
  EXPECT_TRUE(std::none_of(node.motions.begin(), node.motions.end(), has_points));
  EXPECT_EQ(describe(node.action.session()), "idle");
  node.requests = [] {};
  node.begin();
  EXPECT_TRUE(has_points(node.motions.back()));
}

TEST(StepAction, AGoalThatComesWhileAnotherIsPlannedGetsItsStep) {
  RobotJob robot;
  FakeNode node(robot, robot.settings());
  node.begin();
  node.action.report(node.report());
  int more = 2;
  node.requests = [&] {
    if (more-- <= 0) return;
    node.action.abandon();
    node.action.begin();
  };
  node.motions.clear();
  node.steps.clear();
  node.begin();
  EXPECT_EQ(node.ends,
            (std::vector<StepEnd>{StepEnd::succeeded, StepEnd::aborted, StepEnd::aborted}));
  EXPECT_EQ(std::count_if(node.motions.begin(), node.motions.end(), has_points), 1);
  EXPECT_TRUE(has_points(node.motions.back()));
  EXPECT_EQ(node.steps.size(), 1U);
  EXPECT_EQ(describe(node.action.session()), "driving");
  node.action.report(node.report());
  EXPECT_EQ(node.ends.back(), StepEnd::succeeded);
}

/// Sets the step that the job of a folder is to do next.
void ask_for(const std::string& folder, JobAction what, const std::string& reason) {
  JobRecord record = load_record(folder);
  record.present = JobStep();
  record.present->id = record.last_step + 1;
  record.present->what = what;
  record.present->reason = reason;
  save_record(folder, record);
}

TEST(StepAction, AJobIsFinishedIfItsLastStepSaysSo) {
  RobotJob robot;
  {
    Points finished;
    for (int i = 0; i < 300 * 200; ++i) {
      const double x = -7.0 + 0.05 * (i / 200), y = -5.0 + 0.05 * (i % 200);
      const bool is_cut = x > 2.0 && x < 4.5 && std::abs(y) < 0.5;
      finished.emplace_back(x, y, is_cut ? -0.4 : 0.0);
    }
    Scan scan;
    scan.clouds = {std::make_shared<const Cloud>(Cloud{finished})};
    SiteJob job = robot.of.resume();
    job.look(scan, robot.of.truth.time() + 1.0);
    ASSERT_TRUE(job.progress().is_finished);
  }
  for (const bool is_finished : {false, true}) {
    const std::string reason = is_finished ? "finished" : "the soil in the bucket has no place";
    ask_for(robot.of.path(), JobAction::stop, reason);
    FakeNode node(robot, robot.settings());
    node.begin();
    EXPECT_EQ(node.ends, std::vector<StepEnd>{is_finished ? StepEnd::succeeded : StepEnd::aborted});
    EXPECT_EQ(node.last.success, is_finished);
    EXPECT_EQ(node.last.finished, is_finished);
    EXPECT_EQ(node.last.message, is_finished ? "" : reason);
  }
}

TEST(StepAction, AReportOfAnotherStepIsRefusedAndTheGoalGoesOn) {
  RobotJob robot;
  FakeNode node(robot, robot.settings());
  node.begin();
  EXPECT_NE(error_of([&] {
              node.action.report({99, {}, {}, false, {}});
            }).find("step 99"),
            std::string::npos);
  EXPECT_TRUE(node.ends.empty());
  node.action.report(node.report());
  EXPECT_EQ(node.ends.back(), StepEnd::succeeded);
}

TEST(StepAction, AScanThatFailsEndsTheGoal) {
  RobotJob robot;
  JobSessionSettings settings = robot.settings();
  settings.site_frame = "map";
  FakeNode node(robot, settings);
  for (const bool stalls : {false, true, false}) {
    node.begin();
    node.action.report(node.report(stalls));
  }
  robot.scan(node.take(), robot.points_now(), "lidar");
  node.action.poll();
  EXPECT_EQ(node.ends.size(), 2U) << "its transforms may still come";
  robot.later += 2'000'000'000;
  EXPECT_NE(error_of([&] { node.action.poll(); }, ErrorKind::bad_file), "no error");
  EXPECT_EQ(node.ends.back(), StepEnd::aborted);
  EXPECT_NE(node.last.message.find("to be reported again"), std::string::npos);
}

struct DoneRequest {
  long long step = 4;
  bool stalled = true;
  std::vector<double> payload_kg, energy_kj, base;
};

TEST(StepAction, ReadsTheReportOfAService) {
  DoneRequest request;
  MotionReport report = report_of(request);
  EXPECT_TRUE(report.step == 4 && report.stalled);
  EXPECT_FALSE(report.payload_mass || report.joint_work || report.base);
  request.payload_kg = {300.0};
  request.energy_kj = {120.0};
  request.base = {1.0, 2.0, 0.5};
  report = report_of(request);
  EXPECT_EQ(report.payload_mass, 300.0);
  EXPECT_EQ(report.joint_work, 120e3);
  EXPECT_EQ(report.base->heading, 0.5);
  request.base = {1.0};
  EXPECT_EQ(error_of([&] { report_of(request); }), "base: must be x, y and heading, or empty");
  request.base.clear();
  request.payload_kg = {1.0, 2.0};
  EXPECT_EQ(error_of([&] { report_of(request); }), "payload_kg: more than one");
}

}  // namespace
}  // namespace excavplan::test
