// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/dig_cycle_session.hpp>

#include <algorithm>
#include <limits>
#include <optional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/machine/kinematics.hpp>
#include <excavplan/scans/machine_front.hpp>
#include <excavplan/scans/scan_terrain.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "recording/times.hpp"
#include "robot/live_scan.hpp"
#include "robot/message_clock.hpp"
#include "robot/recent_joints.hpp"
#include "robot/recent_transforms.hpp"
#include "support/errors.hpp"
#include "support/ros_bytes.hpp"

namespace excavplan::test {
namespace {

const std::string points_type = "sensor_msgs/msg/PointCloud2";
const std::string tf_type = "tf2_msgs/msg/TFMessage";
const std::string joints_type = "sensor_msgs/msg/JointState";
constexpr std::int64_t now = 1700000000000000000;  // [ns]

DigCycleSettings settings_with(std::size_t scans = 1) {
  static const DigCycleSettings usual = cycle_settings();
  DigCycleSettings settings = usual;
  settings.scans = scans;
  return settings;
}

void send(DigCycleSession& session, const std::string& bytes, const std::string& topic = "/points",
          const std::string& type = points_type, bool is_cdr = true) {
  session.take({topic, type, is_cdr, bytes});
}

Cloud quickstart(const std::string& name) {
  return read_cloud(std::string(EXCAVPLAN_DATA_SOURCE) + "/quickstart/" + name + ".pcd");
}

void drive_quickstart(DigCycleSession& session, Encoding encoding = cdr_little) {
  const bool is_cdr = encoding.serialization == Serialization::cdr;
  const auto bytes = [&](const char* name) {
    return cloud_bytes(now, "site", quickstart(name).points, 0, encoding);
  };
  send(session, bytes("before"), "/points", points_type, is_cdr);
  session.start_dig();
  session.end_dig();
  send(session, bytes("after"), "/points", points_type, is_cdr);
}

constexpr std::size_t ground_width = 60;

/// A square of ground with points every 0.1 m.
Points ground() {
  Points points;
  for (std::size_t i = 0; i < ground_width * ground_width; ++i) {
    const double row = static_cast<double>(i / ground_width);
    const double column = static_cast<double>(i % ground_width);
    points.emplace_back(3.0 + 0.1 * row, -3.0 + 0.1 * column, 0.0);
  }
  return points;
}

TEST(DigCycleSession, AnswersAsTheLibraryDoesForTheSameScans) {
  const DigCycleSettings settings = settings_with();
  DensityEstimate direct;
  Scan after;
  {
    DigScans scans;
    scans.before.clouds = {std::make_shared<Cloud>(quickstart("before"))};
    after.clouds = {std::make_shared<Cloud>(quickstart("after"))};
    scans.after = after;
    DensityOptions options;
    options.soil.kind = settings.soil;
    direct = estimate_density(scans, settings.law, options);
  }
  for (const Encoding& encoding : {ros1, cdr_little}) {
    DigCycleSession session(settings);
    drive_quickstart(session, encoding);
    const CycleEstimate answer = session.estimate();
    ASSERT_TRUE(answer.adopted);
    EXPECT_EQ(answer.estimate.density->percent, direct.density->percent);
    EXPECT_EQ(answer.estimate.bulking->value, direct.bulking->value);
    EXPECT_EQ(session.density().percent, direct.density->percent);
    const auto json = nlohmann::json::parse(to_json(answer));
    EXPECT_EQ(json["density_percent"], direct.density->percent);
    EXPECT_EQ(json["volume"]["excavated_m3"], direct.change.excavated.value);
  }
}

TEST(DigCycleSession, PlansOnTheGroundAsScanned) {
  DigCycleSession session(settings_with());
  drive_quickstart(session);
  session.estimate();
  const CyclePlan answer = session.plan();
  ASSERT_TRUE(answer.plan.dig);
  EXPECT_FALSE(answer.density_is_stated);
  EXPECT_FALSE(has(answer.warnings, "level_ground"));
  EXPECT_TRUE(has(answer.warnings, "posture_unknown"));
  const Machine machine = settings_with().machine;
  Scan after;
  after.clouds = {std::make_shared<Cloud>(quickstart("after"))};
  const Terrain terrain = terrain_from_scan(after, planning_extent(machine), 0.05).terrain;
  const DigPlan direct = plan_dig(machine, settings_with().soil, session.density(), terrain);
  EXPECT_EQ(answer.plan.dig->payload_mass, direct.dig->payload_mass);
  const auto json = nlohmann::json::parse(to_json(answer));
  EXPECT_EQ(json["path"]["start_x_m"], direct.dig->start_x);

  ASSERT_EQ(answer.motion.names.size(), 4U);
  const TrajectoryPoint& end = answer.plan.trajectory.points.back();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(answer.motion.points.back().positions[i], end.joints[static_cast<int>(i)], 1e-9);
  }
  std::int64_t last = -1;
  for (const JointPoint& point : answer.motion.points) {
    EXPECT_GT(point.time_ns, last);
    last = point.time_ns;
    ASSERT_EQ(point.positions.size(), 4U);
    EXPECT_EQ(point.positions[3], 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(std::abs(point.velocities[i]), machine.limits[i].speed);
    }
  }
}

TEST(DigCycleSession, TellsThatTheDigIsNotTheOneItPlanned) {
  for (const bool as_planned : {true, false}) {
    DigCycleSettings settings = settings_with();
    settings.digs_as_planned = as_planned;
    DigCycleSession session(settings);
    session.plan();
    drive_quickstart(session);
    const CycleEstimate answer = session.estimate();  // the quickstart's dig is another one
    EXPECT_EQ(has(answer.warnings, "dug_path_doubtful"), as_planned);
    EXPECT_EQ(answer.adopted, !as_planned);
  }
}

TEST(DigCycleSession, KeepsThePreviousDensityWhereTheEstimateIsNotTrusted) {
  DigCycleSettings settings = settings_with();
  settings.density = GroundDensity(33.0, 4.0);
  DigCycleSession session(settings);
  send(session, cloud_bytes(now, "site", quickstart("before").points));
  session.start_dig();
  session.end_dig();
  send(session, cloud_bytes(now, "site", quickstart("before").points));  // nothing was dug
  const CycleEstimate estimate = session.estimate();
  EXPECT_FALSE(estimate.adopted);
  EXPECT_EQ(session.density().percent, 33.0);
  const CyclePlan plan = session.plan();
  EXPECT_EQ(plan.density.percent, 33.0);
  EXPECT_TRUE(plan.density_is_stated);
  EXPECT_TRUE(has(plan.warnings, "previous_density"));
  EXPECT_NE(to_json(plan).find("previous_density"), std::string::npos);
}

TEST(DigCycleSession, GoesThroughTheCycle) {
  DigCycleSession session(settings_with(2));
  EXPECT_EQ(error_of([&] { session.start_dig(); }), "the dig begins, but no scan came before it");
  EXPECT_EQ(error_of([&] { session.end_dig(); }), "the dig is over, but none had begun");
  EXPECT_EQ(error_of([&] { session.estimate(); }),
            "no dig has been scanned: it is the time before the first dig");
  const std::string cloud = cloud_bytes(now, "site", ground());
  for (int i = 0; i < 3; ++i) send(session, cloud);
  EXPECT_EQ(session.scans(), 2U);
  session.start_dig();
  session.start_dig();
  EXPECT_STREQ(name(session.stage()), "digging");
  send(session, cloud);
  EXPECT_EQ(session.scans(), 0U);
  EXPECT_EQ(error_of([&] { session.estimate(); }),
            "no dig has been scanned: it is the time digging");
  session.end_dig();
  send(session, cloud);
  EXPECT_EQ(describe(session), "after 1 of 2");
  EXPECT_EQ(error_of([&] { session.estimate(); }), "the scan after the dig has 1 of 2 messages");
  send(session, cloud);
  EXPECT_STREQ(name(session.stage()), "done");
  send(session, cloud);
  EXPECT_EQ(session.scans(), 2U);
  EXPECT_EQ(session.estimate().after, 2U);
}

TEST(DigCycleSession, PutsScansIntoTheSiteFrameByTransforms) {
  DigCycleSettings settings = settings_with();
  settings.site_frame = "base";
  DigCycleSession session(settings);
  send(session, cloud_bytes(now, "lidar", ground()));
  EXPECT_EQ(error_of([&] { session.start_dig(); }, ErrorKind::bad_file),
            "transforms: found no transforms on /tf and /tf_static, expected those of 'base'");
  EXPECT_EQ(session.stage(), CycleStage::before);
  const std::string turned =
      transform_bytes({{now, "base", "lidar", {0.0, 0.0, 1.5}, {1.0, 0.0, 0.0, 0.0}}});
  send(session, turned, "/tf_static", tf_type);
  session.start_dig();
  EXPECT_EQ(session.stage(), CycleStage::digging);
}

constexpr std::int64_t second = 1'000'000'000;  // [ns]

/// A session with the frame "base", and one of its sensor.
struct SensedSession {
  SensedSession() : session(settings()) {}

  static DigCycleSettings settings() {
    DigCycleSettings settings = settings_with();
    settings.site_frame = "base";
    return settings;
  }
  void place(std::int64_t at, const std::string& frame = "lidar", double height = 1.5) {
    send(session, transform_bytes({{at, "base", frame, {0.0, 0.0, height}}}), "/tf", tf_type);
  }
  void scan(std::int64_t at) { send(session, cloud_bytes(at, "lidar", ground())); }

  DigCycleSession session;
};

TEST(DigCycleSession, PosesAreFoundWhileTheirTransformsAreKept) {
  SensedSession robot;
  robot.place(now);
  robot.scan(now);
  for (const int later : {40, 60, 61}) robot.place(now + later * second);
  EXPECT_NE(error_of([&] { robot.session.start_dig(); }, ErrorKind::bad_file).find("at -40.000 s"),
            std::string::npos);
  robot.scan(now + 60 * second);
  robot.session.start_dig();
}

TEST(DigCycleSession, OneClockThatIsAheadDropsNoOtherFrame) {
  SensedSession robot;
  robot.place(now);
  robot.place(now + 20 * second, "other");
  robot.scan(now);
  robot.session.start_dig();
  EXPECT_EQ(robot.session.stage(), CycleStage::digging);
}

TEST(DigCycleSession, SlowFramesStayKnownBetweenTheirStamps) {
  SensedSession robot;
  robot.place(now);
  robot.place(now + 15 * second);
  robot.scan(now + 8 * second);
  robot.session.start_dig();
  EXPECT_EQ(robot.session.stage(), CycleStage::digging);
}

TEST(DigCycleSession, FramesOutliveAClockThatIsSetBack) {
  SensedSession robot;
  robot.place(now);
  robot.place(now - 100 * second);
  robot.scan(now - 100 * second);
  robot.session.start_dig();
  EXPECT_EQ(robot.session.stage(), CycleStage::digging);
}

/// A frame that was so high at a time.
StampedTransform raised_to(double height, std::int64_t time, const std::string& child = "lidar") {
  return {"base", child, time, {0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, height}, false};
}

double height_of(const RecentTransforms& transforms, std::int64_t time,
                 const std::string& child = "lidar") {
  return transforms.tree().lookup("base", child, time).translation().z();
}

/// A network may change their order.
TEST(DigCycleSession, TransformsThatComeLateDropNoNewerOnes) {
  RecentTransforms transforms;
  for (const auto& [at, height] : {std::pair(10, 2.0), {9, 1.0}, {20, 1.0}}) {
    transforms.add({raised_to(height, now + at * second)});
  }
  EXPECT_EQ(height_of(transforms, now + 10 * second), 2.0);
  EXPECT_EQ(height_of(transforms, now + 9 * second), 1.0);
}

TEST(DigCycleSession, AFloodOfTransformsIsNotKeptAndDropsNoOtherFrame) {
  constexpr int sent = 60000;  // within 9 s
  constexpr std::int64_t step = second * 9 / sent;
  RecentTransforms transforms;
  transforms.add({raised_to(2.0, now, "slow")});
  for (int i = 0; i < sent; ++i) transforms.add({raised_to(1.0, now + i * step)});
  EXPECT_EQ(height_of(transforms, now, "slow"), 2.0);
  EXPECT_EQ(height_of(transforms, now + sent * step), 1.0);
  EXPECT_NE(error_of([&] { height_of(transforms, now); }, ErrorKind::bad_file), "no error");
}

/// What it sees along its rays is only known if all came from one place.
TEST(DigCycleSession, AScanOfASensorThatMovedHasNoPlaceOfIt) {
  LiveFrame frame;
  frame.points.size = {2, 2};
  frame.points.points = Points(4, Eigen::Vector3d(3.0, 0.0, -2.0));
  frame.pose = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 2.0));
  frame.from_sensor = true;
  LiveFrame later = frame;
  const auto stood = merged({frame, later}).cloud.sensor_origin;
  ASSERT_TRUE(stood);
  EXPECT_EQ(*stood, Eigen::Vector3d(0.0, 0.0, 2.0));
  later.pose->translation().x() = 0.5;
  const LiveScan moved = merged({frame, later});
  EXPECT_FALSE(moved.cloud.sensor_origin);
  EXPECT_EQ(moved.cloud.points.size(), 8U);
}

TEST(DigCycleSession, AveragesOrganisedMessagesOfASensorThatStood) {
  for (const std::size_t width : {ground_width, ground_width * ground_width}) {
    DigCycleSession session(settings_with(3));
    const std::string cloud = cloud_bytes(now, "site", ground(), width);
    for (int i = 0; i < 3; ++i) send(session, cloud);
    session.start_dig();
    session.end_dig();
    for (int i = 0; i < 3; ++i) send(session, cloud);
    EXPECT_EQ(has(session.estimate().warnings, "not_averaged"), width != ground_width) << width;
  }
}

TEST(DigCycleSession, MotionBeginsWhereTheJointsStand) {
  DigCycleSettings settings = settings_with();
  RobotJoints& robot = settings.machine.robot_joints;
  robot[1] = {"stick", -1.0, 0.4};
  DigCycleSession session(settings);
  const auto stand = [&](const std::vector<double>& joints) {
    std::vector<std::pair<std::string, double>> named;
    for (std::size_t i = 0; i < 4; ++i) named.emplace_back(robot[i].name, joints[i]);
    send(session, joint_bytes(now, named), "/joint_states", joints_type);
  };
  CyclePlan plan = session.plan();
  EXPECT_TRUE(has(plan.warnings, "posture_unknown"));
  const JointMotion above = plan.motion;
  const std::vector<double> present = {-0.6, 0.4 - 1.6, 0.5, 0.7};
  stand(present);
  plan = session.plan();
  EXPECT_FALSE(has(plan.warnings, "posture_unknown"));
  EXPECT_TRUE(has(plan.warnings, "level_ground"));
  EXPECT_FALSE(has(plan.warnings, "no_motion"));
  EXPECT_EQ(plan.motion.names[1], "stick");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(plan.motion.points.front().positions[i], present[i], 1e-12) << i;
    EXPECT_NEAR(plan.motion.points.back().positions[i], above.points.back().positions[i], 1e-9);
  }
  EXPECT_EQ(plan.motion.points.front().accelerations.size(), 4U);
}

/// The swing leaves the strip that is planned on.
TEST(DigCycleSession, MotionIsClearOfAllScannedGround) {
  DigCycleSettings settings = settings_with();
  settings.whole_cycle = true;
  const auto planned_on = [&](double half_width, double wall) {
    Points points;
    for (double x = 1.0; x < 9.5; x += 0.1) {
      for (double y = -half_width; y < half_width; y += 0.1) {
        points.emplace_back(x, y, x > 2.0 && x < 4.0 && y > 2.5 && y < 3.5 ? wall : 0.0);
      }
    }
    DigCycleSession session(settings);
    send(session, cloud_bytes(now, "site", points));
    return session.plan();
  };
  const CyclePlan strip = planned_on(1.5, 0.0);
  EXPECT_TRUE(has(strip.warnings, "unseen_way"));
  EXPECT_FALSE(strip.trustworthy);
  EXPECT_FALSE(strip.motion.points.empty());
  EXPECT_TRUE(has(planned_on(9.5, 9.0).warnings, "no_motion"));
  EXPECT_FALSE(has(planned_on(9.5, 0.0).warnings, "no_motion"));
  settings.surroundings = level_swing_ground(settings.machine);
  EXPECT_FALSE(has(planned_on(1.5, 0.0).warnings, "unseen_way"));
  EXPECT_TRUE(has(planned_on(9.5, 9.0).warnings, "no_motion")) << "the present scan counts first";
  settings.surroundings->bank.z += 1.0;
  const CyclePlan shifted = planned_on(1.5, 0.0);
  EXPECT_TRUE(has(shifted.warnings, "surroundings_differ"));
  EXPECT_FALSE(shifted.trustworthy);
  settings.surroundings->bank.cell_size *= 2.0;
  EXPECT_EQ(error_of([&] { DigCycleSession session(settings); }),
            "surroundings: must be of swing_terrain_from_scan() of machine zx120");
  settings.level_ground = true;
  EXPECT_EQ(error_of([&] { DigCycleSession session(settings); }),
            "level_ground: is not known where the surroundings were scanned");
}

TEST(DigCycleSession, SaysWhyThereIsNoMotion) {
  DigCycleSettings settings = settings_with();
  const JointLimits& boom = settings.machine.limits[0];
  DigCycleSession session(settings);
  const auto motion_from = [&](double boom_angle) {
    std::vector<std::pair<std::string, double>> named;
    const std::vector<double> joints = {boom_angle, 1.6, 0.5, 0.0};
    for (std::size_t i = 0; i < 4; ++i) {
      named.emplace_back(settings.machine.robot_joints[i].name, joints[i]);
    }
    send(session, joint_bytes(now, named), "/joint_states", joints_type);
    return session.plan();
  };
  const CyclePlan at_limit = motion_from(boom.lower - 0.01);
  EXPECT_FALSE(has(at_limit.warnings, "no_motion"));
  EXPECT_EQ(at_limit.motion.points.front().positions[0], boom.lower);
  const CyclePlan beyond = motion_from(boom.lower - 0.3);
  ASSERT_TRUE(has(beyond.warnings, "no_motion"));
  EXPECT_TRUE(beyond.plan.dig);
  EXPECT_FALSE(beyond.trustworthy);
  EXPECT_TRUE(beyond.motion.points.empty());
}

/// Points with this stamp that came at another time.
void scan(DigCycleSession& session, std::int64_t stamp,
          std::optional<std::int64_t> received = std::nullopt) {
  static const std::string frame = "site";
  const std::string bytes = cloud_bytes(stamp, frame, ground());
  session.take({"/points", points_type, true, bytes, received});
}

TEST(DigCycleSession, PointsOfTheDigThatComeAfterItDoNotCount) {
  DigCycleSession session(settings_with());
  scan(session, now);
  session.start_dig(now + second);
  session.end_dig(now + 20 * second);
  scan(session, now + 19 * second);
  scan(session, now + 20 * second - 1);
  EXPECT_EQ(describe(session), "after 0 of 1, 2 too early");
  EXPECT_EQ(error_of([&] { session.estimate(); }),
            "the scan after the dig has 0 of 1 messages; 2 messages of points were measured before "
            "the dig was over");
  scan(session, now + 20 * second);
  EXPECT_EQ(session.stage(), CycleStage::done);
  const CycleEstimate answer = session.estimate();
  EXPECT_TRUE(has(answer.warnings, "early_points"));
  EXPECT_FALSE(has(answer.warnings, "not_stamped"));
  session.start_dig(now + 30 * second);
  EXPECT_EQ(session.early_scans(), 0U);
}

TEST(DigCycleSession, TheMarkOfTheBeginHoldsIfTheEndHasNoTime) {
  DigCycleSession session(settings_with());
  scan(session, now);
  session.start_dig(now + second);
  session.end_dig();
  scan(session, now);
  EXPECT_EQ(session.early_scans(), 1U);
  scan(session, now + 2 * second);
  EXPECT_EQ(session.stage(), CycleStage::done);
}

TEST(DigCycleSession, PointsWithoutAStampCountAndAreTold) {
  for (const bool is_received : {true, false}) {
    DigCycleSession session(settings_with());
    const auto at = [&](int seconds) {
      return is_received ? std::optional(now + seconds * second) : std::nullopt;
    };
    scan(session, 0, at(0));
    session.start_dig(now + 5 * second);
    session.end_dig(now + 10 * second);
    scan(session, 0, at(11));
    ASSERT_EQ(session.stage(), CycleStage::done);
    EXPECT_TRUE(has(session.estimate().warnings, "not_stamped"));
  }
}

TEST(DigCycleSession, StampsOfAnotherClockAreComparedByTheirDelay) {
  constexpr std::int64_t year = 365 * 86400 * second;
  for (const std::int64_t offset : {-year, year}) {
    DigCycleSession session(settings_with());
    const auto at = [&](int taken, int came) {
      scan(session, now + offset + taken * second, now + came * second);
    };
    at(0, 0);
    session.start_dig(now + 5 * second);
    session.end_dig(now + 20 * second);
    at(18, 21);
    EXPECT_EQ(session.early_scans(), 1U);
    at(22, 22);
    EXPECT_EQ(session.stage(), CycleStage::done);
  }
}

TEST(DigCycleSession, AStampThatIsWrongIsForgotten) {
  DigCycleSession session(settings_with());
  scan(session, now + 1'000'000 * second, now);
  session.start_dig(now + second);
  session.end_dig(now + 2 * second);
  int refused = 0;
  for (int i = 3; session.stage() != CycleStage::done && i < 100; ++i, ++refused) {
    scan(session, now + i * second, now + i * second);
  }
  EXPECT_EQ(session.stage(), CycleStage::done);
  EXPECT_LE(refused, 21);
}

TEST(DigCycleSession, AMarkEndsWithItsClock) {
  DigCycleSession session(settings_with());
  scan(session, now, now);
  session.start_dig(now + second);
  session.end_dig(now + 60 * second);
  scan(session, now + second, now + second);  // a recording that begins again
  EXPECT_EQ(session.stage(), CycleStage::done);
}

// A sender may state any time: sums and differences stop at the ends of the range.
TEST(DigCycleSession, TimesAtTheEndsOfTheirRangeAreTimesToo) {
  MessageClock clock;
  EXPECT_EQ(clock.time(now, earliest), now - latest);
  EXPECT_EQ(MessageClock().time(-now, latest), latest - now);
  EXPECT_EQ(time_between(0, earliest), -latest);
  EXPECT_EQ(time_between(earliest, latest), latest);
  RecentJoints joints;
  joints.add("boom", {earliest, 1.0});
  EXPECT_EQ(joints.nearest("boom", latest)->position, 1.0);
  joints.add("boom", {latest, 2.0});
  EXPECT_EQ(joints.nearest("boom", earliest)->position, 2.0) << "the first is too old to be kept";
  for (const std::int64_t received : {earliest, latest}) {
    DigCycleSession session(settings_with());
    scan(session, now, received);
    session.start_dig(received);
    session.end_dig(earliest);
    scan(session, now, now);  // after the mark, which is not of another clock
    EXPECT_EQ(session.stage(), CycleStage::done);
    EXPECT_EQ(session.early_scans(), 0U);
  }
}

/// Tells the joint states of a machine: boom, arm, bucket, swing.
struct JointTeller {
  const DigCycleSettings& settings;
  DigCycleSession& session;

  void operator()(std::int64_t stamp, const std::vector<double>& angles,
                  std::optional<std::int64_t> received = std::nullopt) const {
    std::vector<std::pair<std::string, double>> named;
    for (std::size_t i = 0; i < 4; ++i) {
      named.emplace_back(settings.machine.robot_joints[i].name, angles[i]);
    }
    const std::string bytes = joint_bytes(stamp, named);
    session.take({"/joint_states", joints_type, true, bytes, received});
  }
};

TEST(DigCycleSession, JointStatesThatEndedAreNotWhereTheMachineStands) {
  const std::vector<double> angles = {-0.6, 1.6, 0.5, 0.0};
  const DigCycleSettings settings = settings_with();
  for (const bool is_received : {true, false}) {
    DigCycleSession session(settings);
    const JointTeller tell{settings, session};
    const auto at = [&](std::int64_t time) {
      return is_received ? std::optional(time) : std::nullopt;
    };
    tell(now, angles, at(now));
    scan(session, now + second, at(now + second));
    EXPECT_TRUE(session.plan().posture_known);
    scan(session, now + second + second / 100, at(now + second + second / 100));
    const CyclePlan plan = session.plan();
    EXPECT_FALSE(plan.posture_known);
    ASSERT_TRUE(has(plan.warnings, "posture_unknown"));
    EXPECT_NE(to_json(plan).find("no joint states of boom_joint came within 1 s"),
              std::string::npos);
    tell(now + 2 * second, angles, at(now + 2 * second));
    EXPECT_TRUE(session.plan().posture_known);
  }
}

TEST(DigCycleSession, TheAgeOfJointStatesIsThatAtThePlan) {
  const DigCycleSettings settings = settings_with();
  DigCycleSession session(settings);
  JointTeller{settings, session}(now, {-0.6, 1.6, 0.5, 0.0}, now);
  EXPECT_TRUE(session.plan(now + second).posture_known);
  EXPECT_FALSE(session.plan(now + 2 * second).posture_known);
}

TEST(DigCycleSession, AMachineThatMovesOrMayMoveIsNotTrusted) {
  DigCycleSettings settings = settings_with();
  settings.level_ground = true;
  settings.density = GroundDensity(40.0, 2.0);
  const auto plan_after = [&](const std::vector<std::pair<double, double>>& boom) {
    DigCycleSession session(settings);
    const JointTeller tell{settings, session};
    for (const auto& [at, angle] : boom) {
      const std::int64_t time = now + static_cast<std::int64_t>(1e9 * at);
      tell(time, {angle, 1.6, 0.5, 0.0}, time);
    }
    return session.plan();
  };
  const CyclePlan stands = plan_after({{0.0, -0.605}, {0.5, -0.6}});
  EXPECT_TRUE(stands.trustworthy) << to_json(stands);
  const CyclePlan moves = plan_after({{0.0, -0.62}, {0.25, -0.6}, {0.5, -0.6}});
  EXPECT_FALSE(moves.trustworthy);
  EXPECT_NE(to_json(moves).find("boom_joint turned by 0.02"), std::string::npos);
  EXPECT_TRUE(has(plan_after({{0.0, -0.6}, {0.25, -0.62}, {0.5, -0.6}}).warnings, "not_standing"))
      << "to and fro";
  EXPECT_FALSE(has(plan_after({{-1.0, 0.0}, {0.0, -0.6}, {0.5, -0.6}}).warnings, "not_standing"))
      << "before that";
  const CyclePlan unknown = plan_after({{0.0, -0.6}, {0.4, -0.6}});
  EXPECT_FALSE(unknown.trustworthy);
  EXPECT_TRUE(has(unknown.warnings, "not_standing"));
}

/// People and machines move: a scan holds for a minute, and a motion no longer.
TEST(DigCycleSession, AScanThatIsOldEndsTrustAndItsMotionExpires) {
  DigCycleSettings settings = settings_with();
  settings.density = GroundDensity(40.0, 2.0);
  DigCycleSession session(settings);
  send(session, cloud_bytes(now, "site", ground()));
  const CyclePlan young = session.plan(now + 59 * second);
  EXPECT_FALSE(has(young.warnings, "scan_old"));
  ASSERT_TRUE(young.scan_age && young.stamp);
  EXPECT_NEAR(*young.scan_age, 59.0, 1e-6);
  EXPECT_EQ(young.stamp->scanned, now);
  EXPECT_EQ(young.stamp->expires, now + 60 * second);
  const auto confirmed = [&](std::int64_t time) {
    CyclePlan plan = young;
    session.confirm_start(plan, time);
    return plan;
  };
  EXPECT_FALSE(has(confirmed(now + 60 * second).warnings, "stale_plan"));
  const CyclePlan stale = confirmed(now + 61 * second);
  EXPECT_TRUE(has(stale.warnings, "stale_plan"));
  EXPECT_FALSE(stale.trustworthy);
  const CyclePlan old = session.plan(now + 61 * second);
  EXPECT_TRUE(has(old.warnings, "scan_old"));
  EXPECT_FALSE(old.trustworthy);
  EXPECT_NE(to_json(old).find("\"scan_age_s\""), std::string::npos);
}

/// Of a motion of a file, too.
TEST(DigCycleSession, AMotionOfAnotherPlanIsRefused) {
  DigCycleSettings settings = settings_with();
  settings.density = GroundDensity(40.0, 2.0);
  settings.site_from_scan(0, 3) = 0.5;
  DigCycleSession session(settings);
  send(session, cloud_bytes(now, "site", ground()));
  const CyclePlan plan = session.plan(now);
  const auto refused = [&](const std::optional<PlanStamp>& stamp) {
    return has(session.doubts_of(stamp, now), "foreign_plan");
  };
  ASSERT_TRUE(plan.stamp);
  EXPECT_FALSE(refused(plan.stamp));
  EXPECT_TRUE(refused(std::nullopt));
  PlanStamp other = *plan.stamp;
  other.id.back() = other.id.back() == '0' ? '1' : '0';
  EXPECT_TRUE(refused(other));
  PlanStamp elsewhere = *plan.stamp;
  elsewhere.pose.translation().x() += 0.2;
  EXPECT_TRUE(refused(elsewhere));
  session.start_dig();
  EXPECT_TRUE(refused(plan.stamp)) << "its dig has begun";
}

TEST(DigCycleSession, AMotionIsNotTrustedOnceTheMachineLeftItsStart) {
  DigCycleSettings settings = settings_with();
  settings.level_ground = true;
  settings.density = GroundDensity(40.0, 2.0);
  DigCycleSession session(settings);
  const JointTeller tell{settings, session};
  const auto at = [&](double seconds, double swing) {
    const std::int64_t time = now + static_cast<std::int64_t>(1e9 * seconds);
    tell(time, {-0.6, 1.6, 0.5, swing}, time);
  };
  at(0.0, 0.4);
  at(1.0, 0.4);
  const CyclePlan planned = session.plan(now + second);
  ASSERT_TRUE(planned.trustworthy) << to_json(planned);
  const auto confirmed = [&](double seconds) {
    CyclePlan plan = planned;
    session.confirm_start(plan, now + static_cast<std::int64_t>(1e9 * seconds));
    return plan;
  };
  EXPECT_TRUE(confirmed(1.5).trustworthy);
  const CyclePlan silent = confirmed(61.0);
  EXPECT_FALSE(silent.trustworthy) << "joint states ended while it planned";
  EXPECT_TRUE(has(silent.warnings, "start_left"));
  at(60.0, 0.405);
  EXPECT_TRUE(confirmed(60.0).trustworthy);
  at(61.0, 0.42);
  const CyclePlan left = confirmed(61.0);
  EXPECT_FALSE(left.trustworthy);
  EXPECT_NE(to_json(left).find("swing_joint stands 0.02"), std::string::npos) << to_json(left);
}

TEST(DigCycleSession, APlanOnGroundThatIsNotThePresentOneIsNotTrusted) {
  for (const bool is_level : {true, false}) {
    DigCycleSettings settings = settings_with();
    settings.density = GroundDensity(40.0, 2.0);
    settings.level_ground = is_level;
    const CyclePlan plan = DigCycleSession(settings).plan();
    EXPECT_TRUE(has(plan.warnings, "level_ground"));
    EXPECT_EQ(plan.trustworthy, is_level) << to_json(plan);
  }
  DigCycleSession session(settings_with());
  scan(session, now);
  EXPECT_FALSE(has(session.plan().warnings, "ground_before_dig"));
  EXPECT_NE(error_of([&] { session.estimate(); }), "no error");
  EXPECT_FALSE(session.plan().previous_density) << "nothing was dug";
  session.start_dig();
  for (const bool is_over : {false, true}) {
    if (is_over) session.end_dig();
    const CyclePlan plan = session.plan();
    EXPECT_TRUE(has(plan.warnings, "ground_before_dig"));
    EXPECT_FALSE(plan.trustworthy);
    EXPECT_NE(error_of([&] { session.estimate(); }), "no error");
    EXPECT_TRUE(session.plan().previous_density);
  }
  scan(session, now + second);
  EXPECT_FALSE(has(session.plan().warnings, "ground_before_dig"));
}

TEST(DigCycleSession, PlansTellWhatTheirSettingsAreMadeOf) {
  DigCycleSettings settings = settings_with();
  settings.warnings = {{WarningCode::urdf_scaled, "numbers are those of the zx120", false}};
  EXPECT_TRUE(has(DigCycleSession(settings).plan().warnings, "urdf_scaled"));
}

TEST(DigCycleSession, TheNewestJointStatesAreWhereTheMachineStands) {
  const DigCycleSettings settings = settings_with();
  DigCycleSession session(settings);
  const JointTeller tell{settings, session};
  tell(now, {-0.6, 1.6, 0.5, 0.0}, now);  // then by a clock that is half a second ahead
  tell(now + second / 2, {-0.5, 1.5, 0.5, 0.0}, now);
  EXPECT_NEAR(session.plan().motion.points.front().positions[0], -0.5, 1e-12);
}

TEST(DigCycleSession, JointStatesThatComeLateAreThoseOfTheirTime) {
  RecentJoints joints;
  for (const auto& [at, position] : {std::pair(0, 0.1), {2, 0.3}, {1, 0.2}}) {
    joints.add("boom", {now + at * second, position});
  }
  EXPECT_EQ(joints.nearest("boom", now + second)->position, 0.2);
  EXPECT_EQ(joints.nearest("boom", now + 3 * second)->position, 0.3);
  EXPECT_TRUE(joints.reaches("boom", now + 2 * second));
  EXPECT_NEAR(*joints.turned("boom", second), 0.1, 1e-12);
}

TEST(DigCycleSession, JointStatesMayHaveNoStampAndAnyClock) {
  const std::vector<double> angles = {-0.6, 1.6, 0.5, 0.0};
  const DigCycleSettings settings = settings_with();
  for (const std::int64_t stamp : {std::int64_t{0}, 7 * second}) {
    DigCycleSession session(settings);
    const JointTeller tell{settings, session};
    tell(stamp, angles, now);
    scan(session, now, now);
    EXPECT_TRUE(session.plan().posture_known);
    scan(session, now + 3 * second, now + 3 * second);
    EXPECT_FALSE(session.plan().posture_known);
  }
}

TEST(DigCycleSession, ThePostureOfPointsIsTheOneNearestInTime) {
  DigCycleSettings settings = settings_with();
  settings.machine_in_view = true;
  const JointAngles raised(-0.6, 1.6, 0.5);
  const std::vector<double> then = {-0.6, 1.6, 0.5, 0.0}, soon = {-0.6, 1.6, 0.5, 1.5};
  Points points = quickstart("before").points;
  const Eigen::Vector2d pin = link_positions(settings.machine, raised).arm_pin;
  points.emplace_back(pin.x(), 0.0, pin.y());
  const MachineFront front(settings.machine, {0.0, raised});
  const auto of_machine = static_cast<std::uint64_t>(
      std::count_if(points.begin(), points.end(), [&](const auto& p) { return front.holds(p); }));
  ASSERT_GT(of_machine, 0U);
  for (const bool states_first : {true, false}) {
    DigCycleSession session(settings);
    const JointTeller tell{settings, session};
    const auto cloud = [&](std::int64_t stamp) {
      const std::string bytes = cloud_bytes(stamp, "site", points);
      session.take({"/points", points_type, true, bytes});
    };
    const auto states = [&](std::int64_t at) {
      tell(at - second / 10, then);
      tell(at + second / 2, soon);
    };
    const auto both = [&](std::int64_t at) {
      if (states_first) states(at);
      cloud(at);
      if (!states_first) states(at);
    };
    both(now);
    session.start_dig();
    session.end_dig();
    both(now + 60 * second);
    tell(now + 100 * second, soon);
    EXPECT_EQ(session.estimate().estimate.machine_points, 2 * of_machine) << states_first;
  }
}

TEST(DigCycleSession, ASearchEndsInTime) {
  DigCycleSettings settings = settings_with();
  settings.plan.method = PlanMethod::search;
  settings.search_seconds = 1e-9;
  const CyclePlan plan = DigCycleSession(settings).plan();
  EXPECT_TRUE(plan.plan.stopped);
  EXPECT_TRUE(has(plan.warnings, "search_stopped"));
  EXPECT_LT(plan.plan.evaluations, 100);
  EXPECT_TRUE(plan.plan.dig || !plan.plan.reason.empty());
  settings.search_seconds = 0.0;
  EXPECT_EQ(error_of([&] { DigCycleSession session(settings); }),
            "search_seconds is 0, must be above 0");
}

TEST(DigCycleSession, MachineInViewNeedsJointStates) {
  DigCycleSettings settings = settings_with();
  settings.machine_in_view = true;
  DigCycleSession session(settings);
  drive_quickstart(session);
  EXPECT_NE(error_of([&] { session.estimate(); }).find("no joint states"), std::string::npos);
}

TEST(DigCycleSession, RefusesDamagedMessagesAndStaysAsItWas) {
  DigCycleSession session(settings_with());
  const std::string good = cloud_bytes(now, "site", ground());
  send(session, good);
  for (std::size_t length = 0; length < good.size(); length += 1 + length / 8) {
    EXPECT_NE(error_of([&] { send(session, good.substr(0, length)); }, ErrorKind::bad_file),
              "no error")
        << length;
  }
  EXPECT_NE(error_of([&] { send(session, good, "/a", "std_msgs/msg/String"); }, ErrorKind::bad_file)
                .find("/a"),
            std::string::npos);
  EXPECT_EQ(session.scans(), 1U);
  session.start_dig();
}

TEST(DigCycleSession, ChecksItsSettings) {
  EXPECT_EQ(error_of([] { DigCycleSession(settings_with(0)); }), "scans is 0, must be in 1 .. 100");
  DigCycleSettings settings = settings_with();
  settings.site_from_scan(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { DigCycleSession session(settings); }), "no error");
  settings = settings_with();
  settings.oldest_joints = 0.0;
  EXPECT_EQ(error_of([&] { DigCycleSession session(settings); }),
            "oldest_joints [s] is 0, must be above 0");
}

TEST(DigCycleSession, ChecksWhatWouldFailInEveryPlan) {
  const auto error_with = [](const auto& change) {
    DigCycleSettings settings = settings_with();
    change(settings);
    return error_of([&] { DigCycleSession session(settings); });
  };
  using Settings = DigCycleSettings;
  EXPECT_EQ(error_with([](Settings& s) { s.motion.rate = 5.0; }),
            "MotionOptions::rate [1/s] is 5, must be in 10 .. 500");
  EXPECT_EQ(error_with([](Settings& s) { s.plan.trajectory.speed_fraction = 2.0; }),
            "TrajectoryOptions::speed_fraction is 2, must be above 0 and at most 1");
  EXPECT_EQ(error_with([](Settings& s) { s.density = GroundDensity(50.0, -1.0); }),
            "the standard deviation of the density is -1, must be at least 0 and finite");
  EXPECT_EQ(error_with([](Settings& s) { s.machine.limits[1].speed = 0.0; }).rfind("machine ", 0),
            0U);
  EXPECT_NE(error_with([](Settings& s) {
              s.plan.search.objective.dump_height = 30.0;
            }).find("the dump height is 30 m"),
            std::string::npos);
  EXPECT_NE(error_with([](Settings& s) {
              s.plan.search.objective.dump_height = 2.0;
            }).find("dump_height_m"),
            std::string::npos)
      << "the library is for another one";
  EXPECT_EQ(error_with([](Settings& s) {
              s.whole_cycle = true;
              s.machine.robot_joints[3].name.clear();
            }),
            "whole_cycle: the swing joint has no name, so the machine would dump without swinging");
}

}  // namespace
}  // namespace excavplan::test
