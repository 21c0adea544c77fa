// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/job_session.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/machine/kinematics.hpp>

#include "robot/robot_job.hpp"
#include "site/site_digs.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

Take into(JobSession& session) {
  return [&session](const RobotMessage& message) { session.take(message); };
}

/// A step from its plan to its end.
SessionStep do_step(RobotJob& robot, JobSession& session) {
  robot.stand(into(session));
  SessionStep planned = session.plan(robot.now());
  session.confirm_start(planned, robot.now());
  session.report(robot.drive(planned.step), robot.now());
  if (planned.step.what == JobAction::scan) {
    EXPECT_FALSE(session.finish()) << "no scan came yet";
    robot.scan(into(session), points_of(*robot.of.report.scan));
  }
  const auto outcome = session.finish();
  EXPECT_TRUE(outcome && outcome->step.id == planned.step.id);
  EXPECT_FALSE(session.finish());
  return planned;
}

/// Does steps until the next one is such a one. @return that
SessionStep go_on_to(RobotJob& robot, JobSession& session, JobAction what) {
  for (;;) {
    robot.stand(into(session));
    SessionStep planned = session.plan(robot.now());
    if (planned.step.what == what) return planned;
    EXPECT_NE(planned.step.what, JobAction::stop);
    do_step(robot, session);
  }
}

TEST(JobSession, DoesTheStepsOfTheJobWithTheMessagesOfARobot) {
  for (const Encoding& encoding : {ros1, cdr_little}) {
    RobotJob robot(encoding);
    JobSession session(robot.settings());
    const ShortTrench site;
    TrenchJob direct{site};
    SiteJob job = direct.begin();
    int scans = 0;
    while (scans < 1) {
      const JobStep expected = direct.make_step(job);
      const SessionStep found = do_step(robot, session);
      ASSERT_EQ(found.step.id, expected.id);
      ASSERT_EQ(found.step.what, expected.what);
      if (found.step.what == JobAction::scan) ++scans;
      if (!found.step.digs()) continue;
      EXPECT_TRUE(may_be_driven(found)) << to_json(found);
      EXPECT_NEAR(found.step.path.start_x, expected.path.start_x, 1e-3);
      EXPECT_EQ(robot.of.report.payload_mass.has_value(), true);
    }
    EXPECT_NEAR(session.progress().left_volume, job.progress().left_volume, 0.01);
    EXPECT_EQ(session.progress().scans, 1);
    EXPECT_NEAR(session.progress().payload_mass, job.progress().payload_mass, 5.0)
        << "points are rounded to float32";
  }
}

TEST(JobSession, TheMotionBeginsWhereTheMachineStands) {
  RobotJob robot;
  JobSession session(robot.settings());
  const SessionStep first = session.plan();
  ASSERT_EQ(first.step.what, JobAction::move);
  EXPECT_TRUE(first.motion.points.empty() && may_be_driven(first)) << "no joints are known";
  do_step(robot, session);

  SessionStep blind = session.plan(robot.now() + 5'000'000'000);
  ASSERT_TRUE(blind.step.digs());
  EXPECT_TRUE(has(blind.step.warnings, WarningCode::posture_unknown));
  EXPECT_FALSE(may_be_driven(blind));

  const std::vector<double> stands = {-0.6, 1.6, 0.5, 0.4};
  robot.stand(into(session), stands);
  SessionStep planned = session.plan(robot.now());
  session.confirm_start(planned, robot.now());
  EXPECT_TRUE(may_be_driven(planned)) << to_json(planned);
  ASSERT_GT(planned.motion.points.size(), 10U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(planned.motion.points.front().positions[i], stands[i], 1e-9);
  }
  EXPECT_EQ(planned.motion.names.back(), "swing_joint");
  const auto json = nlohmann::json::parse(to_json(planned));
  EXPECT_EQ(json["step"], planned.step.id);
  EXPECT_EQ(json["trajectory_points"], planned.motion.points.size());
  EXPECT_EQ(json["trustworthy"], true);

  robot.stand(into(session), {-0.6, 1.6, 0.5, 0.8});
  session.confirm_start(planned, robot.now());
  EXPECT_TRUE(has(planned.step.warnings, WarningCode::start_left));
  EXPECT_FALSE(may_be_driven(planned));
  robot.later += 100'000'000;
  robot.stand(into(session), {-0.6, 1.6, 0.5, 0.8});
  SessionStep moving = session.plan(robot.now());
  EXPECT_TRUE(may_be_driven(moving)) << to_json(moving);
  robot.stand(into(session), {-0.6, 1.6, 0.5, 0.7}, 1);
  moving = session.plan(robot.now());
  EXPECT_TRUE(has(moving.step.warnings, WarningCode::not_standing));
  EXPECT_FALSE(may_be_driven(moving));
  robot.later += 1'000'000'000;
  robot.stand(into(session), {-3.0, 1.6, 0.5, 0.7});  // beyond its limits
  const SessionStep beyond = session.plan(robot.now());
  EXPECT_TRUE(has(beyond.step.warnings, WarningCode::no_motion));
  EXPECT_FALSE(may_be_driven(beyond));
}

TEST(JobSession, JointsAreNamedAsTheRobotNamesThem) {
  RobotJob robot;
  JobSessionSettings settings = robot.settings();
  settings.joint_names = {"b", "a", "k", "s"};
  EXPECT_EQ(JobSession(settings).machine().robot_joints[3].name, "s");
  settings.joint_names = {"b", "a", "k", ""};
  EXPECT_EQ(error_of([&] { JobSession session(settings); }),
            "joint_names: a job needs one of each joint, the swing too");
  settings.joint_names = {"b"};
  EXPECT_EQ(error_of([&] { JobSession session(settings); }),
            "joint_names: has 1 names, must have 4: boom, arm, bucket, swing");
}

TEST(JobSession, RefusesSettingsThatAreOutOfRange) {
  JobSessionSettings settings;
  EXPECT_EQ(error_of([&] { check(settings); }), "folder: of the job is missing");
  settings.folder = "/nowhere";
  EXPECT_NE(error_of([&] { JobSession session(settings); }, ErrorKind::bad_file), "no error");
  settings.scans = 0;
  EXPECT_NE(error_of([&] { check(settings); }).find("scans is 0"), std::string::npos);
  settings.scans = 1;
  settings.oldest_joints = 0.0;
  EXPECT_NE(error_of([&] { check(settings); }).find("oldest_joints is 0"), std::string::npos);
}

TEST(JobSession, AReportThatDoesNotFitChangesNothing) {
  RobotJob robot;
  JobSession session(robot.settings());
  EXPECT_EQ(error_of([&] {
              session.report({1, {}, {}, false, {}});
            }),
            "the report is of step 1, and none is to be done: nothing is changed");
  const JobStep step = session.plan().step;
  const std::string record = robot.of.record();
  EXPECT_EQ(error_of([&] {
              session.report({7, {}, {}, false, {}});
            }),
            "the report is of step 7, the present one is 1: nothing is changed");
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  // What a report may hold is one check, that of the job: site_job_test.cpp.
  EXPECT_NE(error_of([&] {
              session.report({1, -1.0, {}, false, {}});
            }).find("payload mass of step 1, move [kg] is -1"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              session.report({1, {}, {}, false, BasePose{none, 0.0, 0.0, 0.0}});
            }).find("base of step 1, move [m] is nan"),
            std::string::npos);
  EXPECT_EQ(error_of([&] {
              session.report({1, {}, {}, true, {}});
            }),
            "step 1 is a move and cannot have stalled: only a dig can");
  EXPECT_FALSE(session.finish());
  EXPECT_EQ(describe(session), "driving");
  EXPECT_EQ(robot.of.record(), record);
  session.report({step.id, {}, {}, false, BasePose{step.base.x + 0.1, 0.0, 9.0, 0.0}});
  ASSERT_TRUE(session.finish());
  const JobStep next = session.plan().step;
  EXPECT_EQ(next.base.x, step.base.x + 0.1);
  EXPECT_EQ(next.base.z, step.base.z) << "its height is that of the step";
}

TEST(JobSession, GoesOnAfterAKill) {
  RobotJob robot;
  long long id = 0;
  {
    JobSession session(robot.settings());
    id = go_on_to(robot, session, JobAction::dig).step.id;
    EXPECT_NE(error_of([&] { JobSession second(robot.settings()); }, ErrorKind::bad_file)
                  .find("in use by process"),
              std::string::npos);
  }
  {
    JobSession again(robot.settings());
    const std::string record = robot.of.record();
    const JobStep step = again.plan().step;
    EXPECT_EQ(step.id, id);
    EXPECT_EQ(robot.of.record(), record);
  }
  JobSession told(robot.settings());
  told.report({id, 300.0, {}, false, {}});  // without a plan: the robot drove on
  ASSERT_TRUE(told.finish());
  EXPECT_EQ(error_of([&] {
              told.report({id, 300.0, {}, false, {}});
            }),
            "the report is of step " + std::to_string(id) +
                ", and none is to be done: nothing is changed");
  EXPECT_GT(told.plan().step.id, id);
  EXPECT_EQ(told.progress().digs, 1);
}

TEST(JobSession, CollectsTheScanThatAStepAsksFor) {
  RobotJob robot;
  JobSession session(robot.settings(2));
  const Take take = into(session);
  robot.stand(take);
  JobStep step = session.plan(robot.now()).step;
  session.report(robot.drive(step), robot.now());
  ASSERT_TRUE(session.finish());
  robot.stand(take);
  step = session.plan(robot.now()).step;
  session.report({step.id, {}, {}, true, {}}, robot.now());  // a stall: it looks at once
  ASSERT_TRUE(session.finish());
  step = session.plan(robot.now()).step;
  ASSERT_EQ(step.what, JobAction::scan);

  const Points points = robot.points_now();
  robot.scan(take, points);
  EXPECT_EQ(session.scans(), 0U) << "the step goes on";
  robot.later += 1'000'000'000;
  session.report({step.id, {}, {}, false, {}}, robot.now());
  EXPECT_EQ(describe(session), "scan 0 of 2");
  robot.later -= 500'000'000;
  robot.scan(take, points);
  EXPECT_EQ(describe(session), "scan 0 of 2, 1 too early") << "before the end of the motion";
  robot.later += 500'000'000;
  robot.scan(take, points);
  EXPECT_EQ(describe(session), "scan 1 of 2, 1 too early");
  EXPECT_NE(error_of([&] { robot.send(take, "/points", "sensor_msgs/msg/PointCloud2", "junk"); },
                     ErrorKind::bad_file),
            "no error");
  EXPECT_EQ(describe(session), "scan 1 of 2, 1 too early");
  EXPECT_FALSE(session.finish());

  session.leave();
  EXPECT_EQ(describe(session), "idle");
  EXPECT_EQ(session.plan(robot.now()).step.id, step.id);
  session.report({step.id, {}, {}, false, {}}, robot.now());
  EXPECT_EQ(session.early_scans(), 0U);
  robot.scan(take, points);
  robot.scan(take, points);
  const auto outcome = session.finish();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(has(outcome->warnings, WarningCode::scan_not_taken));
  EXPECT_EQ(outcome->progress.scans, 1);
}

/// A session whose next step is a scan.
struct Scanning {
  explicit Scanning(JobSessionSettings settings) : session(std::move(settings)) {}
  static RobotJob& stalled(RobotJob& robot) {
    JobSession session(robot.settings());
    for (const bool stalls : {false, true}) {
      const JobStep step = session.plan().step;
      MotionReport report = robot.drive(step);
      report.stalled = stalls;
      session.report(report);
      EXPECT_TRUE(session.finish());
    }
    EXPECT_EQ(session.plan().step.what, JobAction::scan);
    return robot;
  }
  void report(const RobotJob& robot) {
    const JobStep step = session.plan(robot.now()).step;
    session.report({step.id, {}, {}, false, {}}, robot.now());
  }
  JobSession session;
};

TEST(JobSession, AScanThatCannotBePlacedKeepsTheStep) {
  RobotJob robot;
  JobSessionSettings settings = Scanning::stalled(robot).settings();
  settings.site_frame = "map";
  Scanning of(settings);
  const std::string record = robot.of.record();
  of.report(robot);
  robot.scan(into(of.session), robot.points_now(), "lidar");
  EXPECT_FALSE(of.session.finish(robot.now() + 1'900'000'000)) << "they may still come";
  EXPECT_NE(
      error_of([&] { (void)of.session.finish(robot.now() + 2'000'000'000); }, ErrorKind::bad_file)
          .find("/tf"),
      std::string::npos);
  EXPECT_EQ(robot.of.record(), record);
  EXPECT_EQ(of.session.stage(), SessionStage::idle);

  Points lifted = robot.points_now();
  for (Eigen::Vector3d& point : lifted) point.z() -= 1.5;
  robot.send(into(of.session), "/tf_static", "tf2_msgs/msg/TFMessage",
             transform_bytes({{robot.now(), "map", "lidar", {0.0, 0.0, 1.5}}}));
  of.report(robot);
  robot.scan(into(of.session), lifted, "lidar");
  const auto outcome = of.session.finish();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(has(outcome->warnings, WarningCode::scan_not_taken));
  EXPECT_EQ(outcome->progress.scans, 1);
}

/// The points as a sensor 1.5 m up tells them.
struct LateTransforms {
  LateTransforms() {
    settings.site_frame = "map";
    for (Eigen::Vector3d& point : lifted) point.z() -= 1.5;
  }
  /// @param age  of its stamp [ns]
  void transform(const Take& take, std::int64_t age) const {
    robot.send(take, "/tf", "tf2_msgs/msg/TFMessage",
               transform_bytes({{robot.now() - age, "map", "lidar", {0.0, 0.0, 1.5}}}));
  }
  RobotJob robot;
  JobSessionSettings settings = Scanning::stalled(robot).settings(2);
  Points lifted = robot.points_now();
};

TEST(JobSession, WaitsForTransformsThatComeLate) {
  LateTransforms late;
  Scanning of(late.settings);
  const Take take = into(of.session);
  late.transform(take, 0);
  late.robot.later += 500'000'000;
  of.report(late.robot);
  for (int i = 0; i < 2; ++i) late.robot.scan(take, late.lifted, "lidar");
  EXPECT_FALSE(of.session.finish(late.robot.now()));
  late.robot.later += 700'000'000;
  late.transform(take, 650'000'000);  // between the points and 0.1 s before them
  const auto outcome = of.session.finish(late.robot.now());
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(has(outcome->warnings, WarningCode::scan_not_taken));
}

TEST(JobSession, WaitsForJointStatesThatComeLateAndDoesWithoutLaterOnes) {
  RobotJob robot;
  JobSessionSettings settings = Scanning::stalled(robot).settings();
  settings.machine_in_view = true;
  Scanning of(settings);
  const Take take = into(of.session);
  robot.stand(take);
  of.report(robot);
  const Points points = robot.points_now();
  robot.scan(take, points);
  EXPECT_FALSE(of.session.finish(robot.now())) << "none is of the time of the points";
  robot.stand(take, {-0.6, 1.6, 0.5, 0.4}, 1);
  EXPECT_TRUE(of.session.finish(robot.now()));

  RobotJob other;
  settings.folder = Scanning::stalled(other).settings().folder;
  Scanning without(settings);
  other.stand(into(without.session));
  without.report(other);
  other.scan(into(without.session), points);
  EXPECT_FALSE(without.session.finish(other.now()));
  EXPECT_TRUE(without.session.finish(other.now() + 2'500'000'000)) << "0.1 s before is as good";
}

/// Simulated time begins anew, or a recording is played once more.
TEST(JobSession, AClockThatIsSetBackKeepsNoScanWaiting) {
  for (const std::int64_t back : {900'000'000LL, 5'000'000'000LL}) {
    RobotJob robot;
    Scanning of(Scanning::stalled(robot).settings());
    robot.later += 10'000'000'000;
    of.report(robot);
    robot.later -= back;
    robot.scan(into(of.session), robot.points_now());
    const bool is_set_back = back > 1'000'000'000;
    EXPECT_EQ(of.session.scans(), is_set_back ? 1U : 0U) << back;
    EXPECT_EQ(of.session.early_scans(), is_set_back ? 0U : 1U) << back;
    EXPECT_EQ(of.session.finish(robot.now()).has_value(), is_set_back) << back;
  }
}

TEST(JobSession, TheSameReportOfAScanAgainChangesNothing) {
  RobotJob robot;
  Scanning of(Scanning::stalled(robot).settings(2));
  JobSession& session = of.session;
  const JobStep step = session.plan(robot.now()).step;
  const MotionReport told = {step.id, {}, 900.0, false, BasePose{0.1, 0.2, 0.0, 0.3}};
  session.report(told, robot.now());
  robot.scan(into(session), robot.points_now());
  EXPECT_EQ(describe(session), "scan 1 of 2");
  robot.later += 500'000'000;
  session.report(told, robot.now());
  EXPECT_EQ(describe(session), "scan 1 of 2");
  const auto refusal = [&](const auto& change) {
    MotionReport other = told;
    change(other);
    return error_of([&] { session.report(other, robot.now()); });
  };
  const std::string text = "the report is of step " + std::to_string(step.id) +
                           ", which was reported otherwise and whose scan is being collected: "
                           "nothing is changed";
  EXPECT_EQ(refusal([](MotionReport& each) { each.joint_work = 901.0; }), text);
  EXPECT_EQ(refusal([](MotionReport& each) { each.payload_mass = 0.0; }), text);
  EXPECT_EQ(refusal([](MotionReport& each) { each.base.reset(); }), text);
  EXPECT_EQ(refusal([](MotionReport& each) { each.base->heading = 0.0; }), text);
  robot.later -= 400'000'000;  // measured after the first report
  robot.scan(into(session), robot.points_now());
  ASSERT_TRUE(session.finish());
  EXPECT_EQ(session.plan().step.base.heading, 0.3) << "where the machine stands, of any step";
}

TEST(JobSession, AScanOfOtherGroundIsNotTaken) {
  RobotJob robot;
  Scanning of(Scanning::stalled(robot).settings());
  Points other;
  for (int i = 0; i < 10000; ++i) {
    const double x = -5.0 + 0.1 * (i / 100), y = -5.0 + 0.1 * (i % 100);
    other.emplace_back(x, y, 3.0 + std::sin(2.0 * x) + std::cos(3.0 * y));
  }
  of.report(robot);
  robot.scan(into(of.session), other);
  const auto outcome = of.session.finish();
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(has(outcome->warnings, WarningCode::scan_not_taken));
}

/// Points on the bucket lie over the trench.
TEST(JobSession, LeavesTheMachineOutOfTheScan) {
  const JointAngles stands(-0.6, 1.6, 0.5);
  const auto left = [&](bool is_in_view, bool is_known) {
    RobotJob robot;
    JobSessionSettings settings = Scanning::stalled(robot).settings();
    settings.machine_in_view = is_known;
    Scanning of(settings);
    Points points = robot.points_now();
    const BucketPose tip = forward_kinematics(of.session.machine(), stands);
    const Eigen::Isometry3d site = of.session.plan().step.base.site_from_machine();
    for (int i = 0; is_in_view && i < 1600; ++i) {
      const double along = tip.x - 0.005 * (i / 40), across = 0.01 * (i % 40 - 20);
      points.push_back(site * Eigen::Vector3d(along, across, tip.z));
    }
    of.report(robot);
    robot.scan(into(of.session), points);
    robot.stand(into(of.session), {stands[0], stands[1], stands[2], 0.0});
    const auto outcome = of.session.finish();
    EXPECT_TRUE(outcome);
    return outcome->progress.left_volume;
  };
  EXPECT_EQ(left(true, true), left(false, true));
  EXPECT_NE(left(true, false), left(false, false));
}

}  // namespace
}  // namespace excavplan::test
