// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/dig_path.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/machine/dig_trials.hpp>
#include "base/random.hpp"

#include "base/angles.hpp"
#include "base/files.hpp"
#include "base/non_finite.hpp"
#include "machine/dig_path_text.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using test::zx120;
using Reason = Infeasible::Reason;

/// The published figures know no undercarriage.
Machine without_tracks(double beta = 50 * degree) {
  Machine machine = zx120();
  machine.track_front = -100.0;
  machine.bucket.profile[1] = Vector2d(1.23, 0) + 0.6 * Vector2d(-std::cos(beta), std::sin(beta));
  if (beta < 45 * degree) machine.bucket.profile[2].y() = 0.6;  // it stays convex
  return machine;
}

double flat(double) { return 0.0; }

using Outcome = std::variant<DigPath, Infeasible>;

DigPath driven(const Outcome& outcome) {
  if (const auto* stopped = std::get_if<Infeasible>(&outcome)) {
    ADD_FAILURE() << stopped->message;
    return {};
  }
  return std::get<DigPath>(outcome);
}

Infeasible stopped(const Outcome& outcome) {
  if (std::holds_alternative<DigPath>(outcome)) {
    ADD_FAILURE() << "the dig can be driven";
    return {};
  }
  return std::get<Infeasible>(outcome);
}

std::vector<DigPose> poses_of(const DigPath& path, DigPhase phase) {
  std::vector<DigPose> poses;
  std::copy_if(path.poses.begin(), path.poses.end(), std::back_inserter(poses),
               [&](const DigPose& pose) { return pose.phase == phase; });
  return poses;
}

double lowest_point(const Machine& machine, const DigPose& pose) {
  const LinkPositions at = link_positions(machine, pose.joints);
  double lowest = at.tip.y();
  for (const Vector2d& corner : machine.bucket.profile) {
    lowest = std::min(lowest, bucket_point(at, corner).y());
  }
  return lowest;
}

DigParameters random_parameters(Random& random) {
  DigParameters parameters;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    parameters.*info.field = random.uniform(info.lower, info.upper);
  }
  return parameters;
}

// ---- published figures --------------------------------------------------------------------------

TEST(DigPath, TableNamesTheThreeNumbersInOrder) {
  const auto& table = dig_parameter_table();
  EXPECT_STREQ(table[0].name, "penetration_angle_rad");
  EXPECT_STREQ(table[1].name, "penetration_length_m");
  EXPECT_STREQ(table[2].name, "drag_length_m");
  const DigParameters fixed = paper_fixed_path();
  EXPECT_NEAR(fixed.*table[0].field, pi / 4, 1e-15);
  EXPECT_EQ(fixed.*table[1].field, 0.35);
  EXPECT_EQ(fixed.*table[2].field, 1.5);
  for (const DigParameterInfo& info : table) {
    EXPECT_GE(fixed.*info.field, info.lower);
    EXPECT_LE(fixed.*info.field, info.upper);
  }
}

TEST(DigParameters, AreAVectorInTheOrderOfTheTable) {
  const DigParameters dig{0.7, 0.2, 2.5};
  const Eigen::VectorXd numbers = to_vector(dig);
  ASSERT_EQ(numbers.size(), 3);
  EXPECT_EQ(numbers, Eigen::Vector3d(0.7, 0.2, 2.5));
  const DigParameters back = to_dig_parameters(Eigen::Vector4d(0.7, 0.2, 2.5, 6.0));
  EXPECT_EQ(to_vector(back), numbers);
}

TEST(DigParameters, OfAPlanComeBackFromItsJson) {
  const std::string file = testing::TempDir() + "dig_path_test_plan.json";
  const DigParameters dig{1.45, 0.05, 1.0 / 3.0};  // the first two outside their search ranges
  const nlohmann::ordered_json path = path_json(dig, 6.05);
  EXPECT_EQ(path.dump(), R"({"penetration_angle_rad":1.45,"penetration_length_m":0.05,)"
                         R"("drag_length_m":0.3333333333333333,"start_x_m":6.05})");
  write_file(file, nlohmann::ordered_json{{"path", path}}.dump());
  const auto [parameters, start_x] = read_planned_path(file);
  EXPECT_EQ(to_vector(parameters), to_vector(dig));
  EXPECT_EQ(start_x, 6.05);
}

TEST(DigParameters, OfNoPlanAreRefused) {
  const std::string file = testing::TempDir() + "dig_path_test_no_plan.json";
  const auto refused = [&](const std::string& text) {
    write_file(file, text);
    return test::error_about([&] { read_planned_path(file); }, file);
  };
  EXPECT_EQ(refused(R"({"path": {"penetration_angle_rad": "steep"}})"),
            "path.penetration_angle_rad: is \"steep\", expected a number");
  EXPECT_EQ(refused(R"({"path": {"penetration_angle_rad": 45}})"),
            "path.penetration_angle_rad: is 45, must be in 0 .. 1.5707963267948966");
  EXPECT_EQ(refused(R"({"path": {"penetration_angle_rad": 1, "penetration_length_m": 0.35,
                        "drag_length_m": 1, "start_x_m": 6050}})"),
            "path.start_x_m: is 6050, must be in -100 .. 100");
  EXPECT_EQ(refused(R"({"path": "dig"})"), "path: expected an object");
  EXPECT_EQ(refused(R"({"path": null})"), "path: is null, this plan has no dig");
  EXPECT_EQ(refused("{}"), "path: is missing");
  EXPECT_EQ(refused(R"({"tool": "simulate-dig", "path": {}})"),
            "tool: is \"simulate-dig\", expected a result of plan-path --json");
}

TEST(DigParameters, AsTextHaveTheirUnits) {
  EXPECT_EQ(path_text(paper_fixed_path()), "45.0 deg, 0.350 m, 1.50 m");
  EXPECT_EQ(path_text(paper_fixed_path(), 6.05), "45.0 deg, 0.350 m, 1.50 m from x = 6.05 m");
}

TEST(DigPath, PaperFixedPathKeepsItsHeelClear) {
  const DigPath path = driven(make_dig_path_anywhere(zx120(), paper_fixed_path(), flat));
  EXPECT_GT(path.heel_clearance, 20 * degree);
  EXPECT_LT(path.heel_clearance, 23 * degree);
  EXPECT_NEAR(poses_of(path, DigPhase::drag).back().bucket.z, -0.247, 0.0005);
  EXPECT_EQ(path.overcut, 0.0);
}

TEST(DigPath, DragCostsTheHeelFifteenDegreesAMetre) {
  for (const double beta : {40 * degree, 50 * degree}) {
    const Machine machine = without_tracks(beta);
    ASSERT_NEAR(machine.beta(), beta, 1e-12);
    for (const double from_boom_pin : {5.5, 6.0, 6.5}) {
      const double start_x = machine.boom_pin.x() + from_boom_pin;
      const DigPath path = driven(make_dig_path(machine, paper_fixed_path(), start_x, flat));
      const double loss = (45 * degree - path.heel_clearance) / 1.5;
      EXPECT_GT(loss, 14.6 * degree - 0.1 * degree);
      EXPECT_LT(loss, 16.4 * degree + 0.1 * degree);
    }
  }
}

TEST(DigPath, PaperFixedPathCanBeDrivenFromThePublishedRange) {
  const Machine machine = without_tracks();
  double nearest = infinity, furthest = -infinity;
  for (double start_x = 2.0; start_x < 9.0; start_x += 0.01) {
    const auto outcome = make_dig_path(machine, paper_fixed_path(), start_x, flat);
    if (!std::holds_alternative<DigPath>(outcome)) continue;
    nearest = std::min(nearest, start_x - machine.boom_pin.x());
    furthest = std::max(furthest, start_x - machine.boom_pin.x());
  }
  EXPECT_NEAR(nearest, 3.8, 0.1);
  EXPECT_NEAR(furthest, 7.0, 0.1);
}

// ---- the rules of the phases --------------------------------------------------------------------

void expect_rules_of_the_paper(const DigPath& path) {
  const DigParameters& p = path.parameters;
  for (const DigPose& pose : poses_of(path, DigPhase::penetrate)) {
    ASSERT_NEAR(pose.bucket.floor_angle, p.penetration_angle, 1e-12);
    const double along = (path.start_x - pose.bucket.x) / std::cos(p.penetration_angle);
    ASSERT_NEAR(path.ground_z - pose.bucket.z, along * std::sin(p.penetration_angle), 1e-9);
    ASSERT_LE(along, p.penetration_length + 1e-9);
  }
  const std::vector<DigPose> drag = poses_of(path, DigPhase::drag);
  const DigPose pushed = poses_of(path, DigPhase::penetrate).back();
  ASSERT_NEAR(pushed.bucket.x - drag.back().bucket.x, p.drag_length, 1e-12);
  for (const DigPose& pose : drag) {
    ASSERT_EQ(pose.bucket.z, pushed.bucket.z);
    ASSERT_NEAR(pose.joints[2], pushed.joints[2], 1e-12);
    ASSERT_GE(pose.bucket.floor_angle, 0.0);
  }
  for (const DigPose& pose : poses_of(path, DigPhase::scoop)) {
    ASSERT_EQ(pose.joints[0], drag.back().joints[0]);
    ASSERT_EQ(pose.joints[1], drag.back().joints[1]);
  }
}

TEST(DigPath, EveryPhaseKeepsItsRuleAndEveryPoseItsLimits) {
  const Machine& machine = zx120();
  Random random(11);
  int count = 0;
  for (int n = 0; n < 10000; ++n) {
    const auto outcome =
        make_dig_path(machine, random_parameters(random), random.uniform(3.0, 8.0), flat);
    if (!std::holds_alternative<DigPath>(outcome)) continue;
    const auto& path = std::get<DigPath>(outcome);
    ++count;
    expect_rules_of_the_paper(path);
    double margin = infinity;
    for (const DigPose& pose : path.poses) {
      const BucketPose actual = forward_kinematics(machine, pose.joints);
      ASSERT_NEAR(actual.x, pose.bucket.x, 1e-12);
      ASSERT_NEAR(actual.z, pose.bucket.z, 1e-12);
      ASSERT_NEAR(actual.floor_angle, pose.bucket.floor_angle, 1e-12);
      margin = std::min(margin, limit_margin(machine, pose.joints).margin);
    }
    ASSERT_EQ(margin, path.limit_margin.margin);
    ASSERT_GE(margin, 0.0);
    ASSERT_GE(lowest_point(machine, path.poses.back()), 0.3);
  }
  EXPECT_GT(count, 1000);
}

TEST(DigPath, PosesAreNoFurtherApartThanTheStep) {
  for (const double step : {0.2, 0.025, 0.001}) {
    DigPathOptions options;
    options.step = step;
    const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, options));
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      const BucketPose &a = path.poses[i - 1].bucket, &b = path.poses[i].bucket;
      ASSERT_LE(std::hypot(b.x - a.x, b.z - a.z), step * (1 + 1e-9));
      ASSERT_GE(path.poses[i].phase, path.poses[i - 1].phase);
    }
  }
}

TEST(DigPath, ScoopEndsWithThePinLevelWithTheTip) {
  const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  const DigPose end = poses_of(path, DigPhase::scoop).back();
  const LinkPositions at = link_positions(zx120(), end.joints);
  EXPECT_NEAR(at.tip.y(), at.bucket_pin.y(), 1e-12);
  EXPECT_LT(at.tip.x(), at.bucket_pin.x());
  EXPECT_NEAR(end.bucket.floor_angle, -zx120().beta(), 1e-12);
}

TEST(DigPath, LiftKeepsTheBucketLevelUntilItIsClear) {
  const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  const std::vector<DigPose> lift = poses_of(path, DigPhase::lift);
  ASSERT_FALSE(lift.empty());
  for (const DigPose& pose : lift) {
    EXPECT_NEAR(pose.bucket.floor_angle, -zx120().beta(), 1e-12);
    EXPECT_EQ(pose.joints[1], lift.front().joints[1]);
  }
  EXPECT_GE(lowest_point(zx120(), lift.back()), 0.3);
  EXPECT_LT(lowest_point(zx120(), lift[lift.size() - 2]), 0.3);
}

TEST(DigPath, LiftClearsTheHighestGroundUnderTheBucket) {
  const auto bank = [](double x) { return x > 4.8 ? 0.5 : 0.0; };  // ends under the bucket
  DigParameters deep = paper_fixed_path();
  deep.drag_length = 0.8;
  const DigPath path = driven(make_dig_path(zx120(), deep, 6.0, bank));
  EXPECT_NEAR(path.ground_z, 0.5, 0.0);
  EXPECT_GE(lowest_point(zx120(), path.poses.back()), 0.8);
}

TEST(DigPath, OvercutIsWhatTheScoopDigsBelowTheDragLine) {
  // Steep and hardly dragged: the tip is still ahead of its pin when the bucket starts to turn.
  const DigParameters steep{1.2, 0.4, 0.3};
  const DigPath path = driven(make_dig_path(zx120(), steep, 5.5, flat));
  double deepest = 0.0;
  for (const DigPose& pose : path.poses) deepest = std::min(deepest, pose.bucket.z);
  const double drag_line = poses_of(path, DigPhase::drag).back().bucket.z;
  EXPECT_GT(path.overcut, 0.02);
  EXPECT_NEAR(path.overcut, drag_line - deepest, 1e-3);
}

TEST(DigPath, FollowsTheGroundUpAndDown) {
  for (const double height : {-0.8, 0.6}) {
    const DigPath path =
        driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, [&](double) { return height; }));
    EXPECT_EQ(path.ground_z, height);
    EXPECT_NEAR(path.poses.front().bucket.z, height, 1e-15);
    EXPECT_NEAR(poses_of(path, DigPhase::drag).back().bucket.z, height - 0.35 * std::sin(pi / 4),
                1e-12);
    EXPECT_GE(lowest_point(zx120(), path.poses.back()), height + 0.3);
  }
}

TEST(DigPath, MayLeaveTheGroundWhileDragging) {
  const auto hole = [](double x) { return x < 5.0 ? -1.5 : 0.0; };
  const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, hole));
  EXPECT_NEAR(poses_of(path, DigPhase::drag).back().bucket.z, -0.2475, 1e-4);
}

// ---- parameters at the edge ---------------------------------------------------------------------

TEST(DigPath, EmptyPhasesAreLeftOut) {
  const DigPath no_push = driven(make_dig_path(zx120(), {0.7, 0.0, 1.0}, 6.0, flat));
  EXPECT_EQ(no_push.poses.front().phase, DigPhase::drag);
  EXPECT_EQ(no_push.poses.front().bucket.x, 6.0);
  EXPECT_TRUE(poses_of(no_push, DigPhase::penetrate).empty());

  const DigPath no_drag = driven(make_dig_path(zx120(), {0.7, 0.3, 0.0}, 6.0, flat));
  EXPECT_TRUE(poses_of(no_drag, DigPhase::drag).empty());
  EXPECT_NEAR(no_drag.heel_clearance, 0.7, 1e-15);

  const DigPath scoop_only = driven(make_dig_path(zx120(), {0.7, 0.0, 0.0}, 6.0, flat));
  EXPECT_EQ(scoop_only.poses.front().phase, DigPhase::scoop);
  EXPECT_EQ(scoop_only.poses.front().bucket.x, 6.0);
  EXPECT_NEAR(scoop_only.poses.front().bucket.floor_angle, 0.7, 1e-15);
}

TEST(DigPath, PathsShorterThanTheStepHaveBothEnds) {
  for (const double tiny : {1e-3, 1e-9, 1e-310}) {
    const DigPath path = driven(make_dig_path(zx120(), {0.7, tiny, tiny}, 6.0, flat));
    EXPECT_EQ(poses_of(path, DigPhase::penetrate).size(), 2u) << tiny;
    EXPECT_EQ(poses_of(path, DigPhase::drag).size(), 1u) << tiny;
  }
}

TEST(DigPath, BadParametersAreValues) {
  const auto refuse = [](double angle, double push, double drag, const std::string& text) {
    for (const Outcome& outcome : {make_dig_path(zx120(), {angle, push, drag}, 6.0, flat),
                                   make_dig_path_anywhere(zx120(), {angle, push, drag}, flat)}) {
      const Infeasible found = stopped(outcome);
      EXPECT_EQ(found.reason, Reason::bad_parameter);
      EXPECT_EQ(found.message, text);
    }
  };
  const std::string rule = ", must be above 0 and below 90 deg";
  refuse(0.0, 0.3, 1.0, "the penetration angle is 0.00 deg" + rule);
  refuse(-0.1, 0.3, 1.0, "the penetration angle is -5.73 deg" + rule);
  refuse(pi / 2, 0.3, 1.0, "the penetration angle is 90.00 deg" + rule);
  refuse(2.0, 0.3, 1.0, "the penetration angle is 114.59 deg" + rule);
  refuse(nan, 0.3, 1.0, "the penetration angle is nan deg" + rule);
  refuse(infinity, 0.3, 1.0, "the penetration angle is inf deg" + rule);
  refuse(0.7, -0.3, 1.0, "the penetration length is -0.300 m, must be at least 0 and finite");
  refuse(0.7, nan, 1.0, "the penetration length is nan m, must be at least 0 and finite");
  refuse(0.7, 0.3, -1e-300, "the drag length is -0.000 m, must be at least 0 and finite");
  refuse(0.7, 0.3, infinity, "the drag length is inf m, must be at least 0 and finite");
  for (const double x : {nan, infinity, -infinity}) {
    EXPECT_EQ(stopped(make_dig_path(zx120(), paper_fixed_path(), x, flat)).reason,
              Reason::bad_parameter);
  }
}

TEST(DigPath, AbsurdLengthsAndPlacesAreOutOfReach) {
  for (const double huge : {20.0, 1e9, 1.7e308}) {
    const Infeasible pushed = stopped(make_dig_path(zx120(), {0.7, huge, 1.0}, 6.0, flat));
    EXPECT_EQ(pushed.phase, DigPhase::penetrate);
    EXPECT_EQ(pushed.reason, Reason::too_deep);
    const Infeasible dragged =
        stopped(make_dig_path(without_tracks(), {1.4, 0.1, huge}, 6.0, flat));
    EXPECT_EQ(dragged.phase, DigPhase::drag);
    for (const double x : {huge, -huge}) {
      const Infeasible placed = stopped(make_dig_path(without_tracks(), {0.7, 0.3, 1.0}, x, flat));
      EXPECT_EQ(placed.reason, Reason::out_of_reach);
      EXPECT_EQ(placed.distance, 0.0);
    }
    for (const double z : {huge, -huge}) {
      EXPECT_EQ(stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, [&](double) { return z; }))
                    .reason,
                Reason::out_of_reach);
    }
  }
}

// ---- why a dig cannot be driven -----------------------------------------------------------------

TEST(DigPath, TellsWhereItStopsAndWhy) {
  const Infeasible far = stopped(make_dig_path(zx120(), paper_fixed_path(), 8.0, flat));
  EXPECT_EQ(far.reason, Reason::out_of_reach);
  EXPECT_NEAR(far.limit, 7.119, 1e-12);
  EXPECT_EQ(
      far.message,
      "penetrate, after 0.000 m: the bucket pin would be 7.755 m from the boom pin, it must be "
      "at most 7.119 m");
  const Infeasible near =
      stopped(make_dig_path(without_tracks(), {0.7, 0.2, 0.3}, 0.8, [](double) { return 1.5; }));
  EXPECT_EQ(near.reason, Reason::out_of_reach);
  EXPECT_NEAR(near.limit, 2.081, 1e-12);
  EXPECT_LT(near.value, near.limit);
  EXPECT_NE(near.message.find("it must be at least 2.081 m"), std::string::npos);
}

TEST(DigPath, FindsJointLimitsAtStartMiddleAndEnd) {
  const Infeasible start = stopped(make_dig_path(zx120(), paper_fixed_path(), 7.2, flat));
  EXPECT_EQ(start.reason, Reason::joint_limit);
  EXPECT_EQ(start.joint, Joint::arm);
  EXPECT_EQ(start.distance, 0.0);
  EXPECT_LT(start.value, start.limit);
  EXPECT_EQ(start.message,
            "penetrate, after 0.000 m: the arm would be at 25.74 deg, its limit is 30.00 deg");

  const Infeasible middle = stopped(make_dig_path(without_tracks(), paper_fixed_path(), 3.6, flat));
  EXPECT_EQ(middle.phase, DigPhase::drag);
  EXPECT_EQ(middle.joint, Joint::arm);
  EXPECT_NEAR(middle.distance, 0.9, 0.05);

  Machine stiff = zx120();
  stiff.limits[2].upper = 1.2;
  const DigPath free = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  const Infeasible end = stopped(make_dig_path(stiff, paper_fixed_path(), 6.0, flat));
  EXPECT_EQ(end.phase, DigPhase::scoop);
  EXPECT_EQ(end.reason, Reason::joint_limit);
  EXPECT_EQ(end.joint, Joint::bucket);
  EXPECT_NEAR(end.distance, 1.2 - poses_of(free, DigPhase::drag).back().joints[2], 1e-12);
  EXPECT_NEAR(end.value, poses_of(free, DigPhase::scoop).back().joints[2], 1e-12);

  Machine low_boom = zx120();
  low_boom.limits[0].lower =
      free.poses[poses_of(free, DigPhase::penetrate).size()].joints[0] - 0.02;
  EXPECT_EQ(stopped(make_dig_path(low_boom, paper_fixed_path(), 6.0, flat)).joint, Joint::boom);
}

TEST(DigPath, HeelThatPressesOnTheCutStopsTheDrag) {
  const Infeasible found = stopped(make_dig_path(zx120(), {0.25, 0.35, 1.5}, 6.0, flat));
  EXPECT_EQ(found.reason, Reason::heel_contact);
  EXPECT_EQ(found.phase, DigPhase::drag);
  const double allowed = DigPathOptions{}.min_heel_clearance;
  EXPECT_NEAR(found.distance, (0.25 - allowed) / (15.5 * degree), 0.1);
  EXPECT_LT(found.value, allowed);
  EXPECT_NE(found.message.find("its heel needs at least 2.01 deg"), std::string::npos)
      << found.message;

  DigPathOptions careful;
  careful.min_heel_clearance = 25 * degree;
  const Infeasible refused =
      stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, careful));
  EXPECT_EQ(refused.reason, Reason::heel_contact);
  careful.min_heel_clearance = 50 * degree;
  EXPECT_EQ(stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, careful)).distance, 0.0);
  careful.min_heel_clearance = 20 * degree;
  driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, careful));
}

TEST(DigPath, StaysAboveTheDepthLimitAndAheadOfTheTracks) {
  DigPathOptions shallow;
  shallow.max_depth = 0.2;
  const Infeasible deep = stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, shallow));
  EXPECT_EQ(deep.reason, Reason::too_deep);
  EXPECT_NEAR(deep.distance, 0.3, 1e-9);
  EXPECT_EQ(deep.message,
            "penetrate, after 0.300 m: the tip is 0.212 m below the ground at the start, it may go "
            "0.200 m");
  const DigParameters overcutting{1.2, 0.4, 0.3};
  const DigPath path = driven(make_dig_path(zx120(), overcutting, 5.5, flat));
  shallow.max_depth = 0.4 * std::sin(1.2) + 0.5 * path.overcut;
  EXPECT_EQ(stopped(make_dig_path(zx120(), overcutting, 5.5, flat, shallow)).phase,
            DigPhase::scoop);

  const Infeasible tracks = stopped(make_dig_path(zx120(), paper_fixed_path(), 4.0, flat));
  EXPECT_EQ(tracks.reason, Reason::too_near_tracks);
  EXPECT_LT(tracks.value, 2.3);
  EXPECT_NEAR(tracks.limit, 2.3, 1e-12);
}

TEST(DigPath, UnknownGroundAtTheStartIsAnswered) {
  for (const double unknown : {nan, infinity, -infinity}) {
    const auto ground = [&](double x) { return x > 5.5 ? unknown : 0.0; };
    const Infeasible found = stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, ground));
    EXPECT_EQ(found.reason, Reason::unknown_ground);
    EXPECT_EQ(found.message,
              "penetrate, after 0.000 m: the height of the ground at the start point, x = 6.000 m, "
              "is not known");
    // Elsewhere it is known, so a dig is found there.
    EXPECT_LE(driven(make_dig_path_anywhere(zx120(), paper_fixed_path(), ground)).start_x, 5.5);
  }
  const auto only_start_known = [](double x) { return x > 5.5 ? 0.2 : nan; };
  const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, only_start_known));
  EXPECT_GE(lowest_point(zx120(), path.poses.back()), 0.2 + 0.3);
}

TEST(DigPath, LiftThatCannotClearIsBlocked) {
  const auto cliff = [](double x) { return x < 4.8 ? 9.0 : 0.0; };
  const Infeasible found = stopped(make_dig_path(zx120(), paper_fixed_path(), 6.0, cliff));
  EXPECT_EQ(found.reason, Reason::lift_blocked);
  EXPECT_EQ(found.phase, DigPhase::lift);
  EXPECT_LT(found.value, 0.3);
  EXPECT_NEAR(found.limit, 0.3, 1e-15);
}

TEST(DigPath, BucketAtItsLimitMayOpenOnceItIsOutOfTheGround) {
  const DigPath free = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  const std::vector<DigPose> lift = poses_of(free, DigPhase::lift);
  Machine stiff = zx120();
  const auto out = std::find_if(lift.begin(), lift.end(), [](const DigPose& pose) {
    return lowest_point(zx120(), pose) > 0.02;
  });
  ASSERT_NE(out, lift.end());
  stiff.limits[2].upper = out->joints[2];
  const DigPath opened = driven(make_dig_path(stiff, paper_fixed_path(), 6.0, flat));
  EXPECT_GT(opened.poses.back().bucket.floor_angle, -zx120().beta() + 0.01);
  EXPECT_EQ(opened.poses.back().joints[2], stiff.limits[2].upper);
  EXPECT_GE(lowest_point(stiff, opened.poses.back()), 0.3);

  const DigParameters deep{pi / 4, 0.9, 1.5};  // ends its scoop with the floor in the ground
  const DigPath freed = driven(make_dig_path(zx120(), deep, 6.0, flat));
  ASSERT_LT(lowest_point(zx120(), poses_of(freed, DigPhase::scoop).back()), -0.05);
  stiff.limits[2].upper = poses_of(freed, DigPhase::scoop).back().joints[2] + 1e-6;
  const Infeasible blocked = stopped(make_dig_path(stiff, deep, 6.0, flat));
  EXPECT_EQ(blocked.reason, Reason::lift_blocked);
  EXPECT_EQ(blocked.joint, Joint::bucket);
}

// ---- the way down -------------------------------------------------------------------------------

TEST(WayDown, LowersTheBucketInItsAttitudeFromWhereItIsClear) {
  Random random(31);
  for (int n = 0; n < 200; ++n) {
    const double slope = std::tan(random.uniform(-0.3, 0.3));
    const auto ground = [slope](double x) { return slope * (x - 6.0); };
    const auto outcome = make_dig_path_anywhere(zx120(), random_parameters(random), ground);
    if (std::holds_alternative<Infeasible>(outcome)) continue;
    const auto& path = std::get<DigPath>(outcome);
    const auto down = way_down(zx120(), path, ground);
    ASSERT_TRUE(std::holds_alternative<std::vector<DigPose>>(down));
    std::vector<DigPose> poses = std::get<std::vector<DigPose>>(down);
    const DigPose& start = path.poses.front();
    ASSERT_FALSE(poses.empty());
    const LinkPositions at = link_positions(zx120(), poses.front().joints);
    EXPECT_GE(lowest_point(zx120(), poses.front()), ground(at.tip.x()) + 0.3 - 1e-12);
    poses.push_back(start);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      EXPECT_EQ(poses[i - 1].phase, DigPhase::approach);
      EXPECT_EQ(poses[i - 1].joints[1], start.joints[1]);
      EXPECT_NEAR(poses[i - 1].bucket.floor_angle, start.bucket.floor_angle, 1e-12);
      EXPECT_GE(limit_margin(zx120(), poses[i - 1].joints).margin, 0.0);
      EXPECT_GT(poses[i - 1].bucket.z, poses[i].bucket.z);
      EXPECT_LE(std::hypot(poses[i - 1].bucket.x - poses[i].bucket.x,
                           poses[i - 1].bucket.z - poses[i].bucket.z),
                0.025 + 1e-12);
    }
  }
}

TEST(WayDown, SaysWhatBlocksIt) {
  const DigPath path = driven(make_dig_path(zx120(), paper_fixed_path(), 6.0, flat));
  Machine low = zx120();
  low.limits[0].lower = path.poses.front().joints[0] - 0.01;
  const auto outcome = way_down(low, path, flat);
  ASSERT_TRUE(std::holds_alternative<Infeasible>(outcome));
  const auto& blocked = std::get<Infeasible>(outcome);
  EXPECT_EQ(blocked.reason, Reason::lift_blocked);
  EXPECT_EQ(blocked.phase, DigPhase::approach);
  EXPECT_EQ(blocked.message.rfind("approach, after 0.0", 0), 0u) << blocked.message;
  EXPECT_THROW(way_down(zx120(), DigPath(), flat), Error);
}

// ---- options ------------------------------------------------------------------------------------

TEST(DigPath, BadOptionsAreErrorsThatNameThem) {
  const auto with = [](double DigPathOptions::*field, double value) {
    DigPathOptions options;
    options.*field = value;
    return test::error_of([&] { make_dig_path(zx120(), paper_fixed_path(), 6.0, flat, options); });
  };
  const std::string step_rule = ", must be above 0 m and finite";
  EXPECT_EQ(with(&DigPathOptions::step, 0.0), "DigPathOptions::step is 0" + step_rule);
  EXPECT_EQ(with(&DigPathOptions::step, nan), "DigPathOptions::step is nan" + step_rule);
  EXPECT_EQ(with(&DigPathOptions::step, infinity), "DigPathOptions::step is inf" + step_rule);
  EXPECT_EQ(
      with(&DigPathOptions::step, 1e-9),
      "DigPathOptions::step is 1e-09, must be so large that no phase has more than 10000 poses");
  EXPECT_EQ(with(&DigPathOptions::min_heel_clearance, -0.1),
            "DigPathOptions::min_heel_clearance is -0.1, must be in 0 .. pi/2 rad");
  EXPECT_EQ(with(&DigPathOptions::max_depth, nan),
            "DigPathOptions::max_depth is nan, must be above 0 m");
  EXPECT_EQ(with(&DigPathOptions::track_margin, infinity),
            "DigPathOptions::track_margin is inf, must be finite");
  EXPECT_EQ(with(&DigPathOptions::lift_clearance, -1.0),
            "DigPathOptions::lift_clearance is -1, must be at least 0 m and finite");
  EXPECT_EQ(with(&DigPathOptions::step, 0.1), "no error");
}

// ---- choice of the start point ------------------------------------------------------------------

double margin_of(const DigPath& path) {
  return std::min(path.limit_margin.margin,
                  path.heel_clearance - DigPathOptions{}.min_heel_clearance);
}

TEST(DigPathAnywhere, IsAsGoodAsTheBestStartOfAnExhaustiveSearch) {
  Random random(12);
  for (int n = 0; n < 100; ++n) {
    const DigParameters parameters = random_parameters(random);
    double best = -infinity;
    for (int i = 46; i <= 170; ++i) {
      const auto outcome = make_dig_path(zx120(), parameters, i / 20.0, flat);
      if (const auto* path = std::get_if<DigPath>(&outcome)) {
        best = std::max(best, margin_of(*path));
      }
    }
    const auto chosen = make_dig_path_anywhere(zx120(), parameters, flat);
    ASSERT_EQ(std::holds_alternative<DigPath>(chosen), best > -infinity);
    if (best == -infinity) continue;
    EXPECT_NEAR(margin_of(std::get<DigPath>(chosen)), best, 0.1 * degree);
    EXPECT_NEAR(std::remainder(std::get<DigPath>(chosen).start_x, 0.05), 0.0, 1e-12);
  }
}

// With steps of 0.3 m no phase has more poses than the scan lays out.
TEST(DigPathAnywhere, IsTheBestStartWhereTheScanHasAllPoses) {
  DigPathOptions coarse;
  coarse.step = 0.3;
  Random random(14);
  int drivable = 0;
  for (int n = 0; n < 100; ++n) {
    const DigParameters parameters = random_parameters(random);
    double best = -infinity;
    for (int i = 46; i <= 170; ++i) {
      const auto outcome = make_dig_path(zx120(), parameters, i / 20.0, flat, coarse);
      if (const auto* path = std::get_if<DigPath>(&outcome)) {
        best = std::max(best, margin_of(*path));
      }
    }
    const auto chosen = make_dig_path_anywhere(zx120(), parameters, flat, coarse);
    ASSERT_EQ(std::holds_alternative<DigPath>(chosen), best > -infinity);
    if (best == -infinity) continue;
    EXPECT_NEAR(margin_of(std::get<DigPath>(chosen)), best, 1e-9);
    ++drivable;
  }
  EXPECT_GT(drivable, 50);
}

TEST(DigPathAnywhere, TakesTheMiddleOfEquals) {
  // Pushed only a little and hardly dragged, the heel stays where it is: the margin is the angle.
  const DigParameters parameters{0.3, 0.1, 1e-12};
  const DigPath chosen = driven(make_dig_path_anywhere(zx120(), parameters, flat));
  double low = infinity, high = -infinity;
  for (int i = 46; i <= 170; ++i) {
    const auto outcome = make_dig_path(zx120(), parameters, i / 20.0, flat);
    const auto* path = std::get_if<DigPath>(&outcome);
    if (path == nullptr || margin_of(*path) < 0.3 - DigPathOptions{}.min_heel_clearance - 1e-9)
      continue;
    low = std::min(low, i / 20.0);
    high = std::max(high, i / 20.0);
  }
  ASSERT_GT(high - low, 0.5);
  EXPECT_NEAR(chosen.start_x, 0.5 * (low + high), 0.051);
}

TEST(DigPathAnywhere, SaysWhyTheBestOfTheFailingStartPointsFails) {
  const Infeasible heel = stopped(make_dig_path_anywhere(zx120(), {0.25, 0.35, 2.5}, flat));
  EXPECT_EQ(heel.reason, Reason::heel_contact);
  EXPECT_GT(heel.distance, 0.7);
  EXPECT_FALSE(heel.message.empty());
  EXPECT_EQ(stopped(make_dig_path_anywhere(zx120(), {0.7, 0.3, 1e9}, flat)).phase, DigPhase::drag);
  EXPECT_EQ(stopped(make_dig_path_anywhere(zx120(), paper_fixed_path(), [](double) { return nan; }))
                .reason,
            Reason::unknown_ground);
  EXPECT_EQ(
      stopped(make_dig_path_anywhere(zx120(), paper_fixed_path(), [](double) { return 50.0; }))
          .reason,
      Reason::out_of_reach);
  DigPathOptions beyond;
  beyond.track_margin = 1e9;
  EXPECT_FALSE(
      stopped(make_dig_path_anywhere(zx120(), paper_fixed_path(), flat, beyond)).message.empty());
  beyond.track_margin = -1e9;
  driven(make_dig_path_anywhere(zx120(), paper_fixed_path(), flat, beyond));
}

// The scoop is deepest between two poses of the scan: starts survive it that full sampling refuses.
TEST(DigPathAnywhere, SaysWhyTheBestFailsWhereTheScanMissedWhatStopsThemAll) {
  const DigParameters digs[] = {{1.0, 0.5, 0.7}, {1.0, 0.6, 0.8}, {1.0, 0.7, 0.8}, {1.1, 0.8, 1.1}};
  for (const DigParameters& parameters : digs) {
    DigPathOptions options;
    options.max_depth = infinity;
    std::vector<Outcome> outcomes;
    const auto start_everywhere = [&] {
      outcomes.clear();
      for (int i = 46; i <= 170; ++i) {
        outcomes.push_back(make_dig_path(zx120(), parameters, i / 20.0, flat, options));
      }
    };
    start_everywhere();
    double least_depth = infinity;
    for (const Outcome& outcome : outcomes) {
      if (std::holds_alternative<Infeasible>(outcome)) continue;
      double depth = 0.0;
      for (const DigPose& pose : std::get<DigPath>(outcome).poses) {
        depth = std::max(depth, -pose.bucket.z);
      }
      least_depth = std::min(least_depth, depth);
    }
    options.max_depth = least_depth - 2e-4;
    start_everywhere();
    std::pair<DigPhase, double> best(DigPhase::approach, 0.0);
    for (const Outcome& outcome : outcomes) {
      const Infeasible failed = stopped(outcome);
      best = std::max(best, {failed.phase, failed.distance});
    }
    const Infeasible told = stopped(make_dig_path_anywhere(zx120(), parameters, flat, options));
    EXPECT_EQ(told.phase, best.first);
    EXPECT_EQ(told.distance, best.second);
    EXPECT_FALSE(told.message.empty());
  }
}

// 24-29 % of the search box press the heel on the ground wherever they start; all else is drivable.
TEST(DigPathAnywhere, OnlyTheHeelLimitsTheSearchBox) {
  const Machine machine = without_tracks();
  DigPathOptions options;
  options.min_heel_clearance = 2 * degree;
  Random random(13);
  int pressed = 0;
  const int count = 2000;
  for (int n = 0; n < count; ++n) {
    const auto outcome = make_dig_path_anywhere(machine, random_parameters(random), flat, options);
    if (const auto* failed = std::get_if<Infeasible>(&outcome)) {
      EXPECT_EQ(failed->reason, Reason::heel_contact) << failed->message;
      ++pressed;
    }
  }
  EXPECT_GT(pressed, 0.23 * count);
  EXPECT_LT(pressed, 0.29 * count);
}

TEST(DigPathAnywhere, LongDragsNeedThePublishedSteepness) {
  DigPathOptions options;
  options.min_heel_clearance = 2 * degree;
  const double published[5][2] = {{1.0, 18}, {1.5, 26}, {2.0, 34}, {2.5, 42}, {3.0, 49}};
  for (const auto& [drag_length, angle] : published) {
    const auto drivable = [&, length = drag_length](double degrees) {
      const DigParameters parameters{degrees * degree, 0.35, length};
      return std::holds_alternative<DigPath>(
          make_dig_path_anywhere(zx120(), parameters, flat, options));
    };
    EXPECT_FALSE(drivable(angle - 1.0)) << drag_length;
    EXPECT_TRUE(drivable(angle + 1.0)) << drag_length;
  }
}

// ---- Trials -------------------------------------------------------------------------------------

/// Ground that bends, and ends.
double bent(double x) { return x > 8.5 ? nan : 0.2 * std::sin(x); }

TEST(DigTrials, LayOutWhatMakeDigPathDoesFromEveryStart) {
  int drivable = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Random random(5, i);
    const DigParameters dig = {random.uniform(0.1, 1.5), random.uniform(0.0, 1.2),
                               random.uniform() < 0.2 ? 0.0 : random.uniform(0.0, 3.0)};
    DigPathOptions options;
    options.step = random.uniform() < 0.5 ? 0.2 : 0.03;
    options.penetration_clearance = random.uniform(0.0, 0.1);
    options.drag_grade = random.uniform(-0.3, 0.3);
    options.drag_keeps_angle = random.uniform() < 0.3;
    if (random.uniform() < 0.3) options.floor = [](double) { return -0.4; };
    options.drag_follows_floor = options.floor && random.uniform() < 0.3;
    const GroundProfile ground = bent;
    const DigTrials trials(zx120(), dig, ground, options);
    for (double x = 2.0; x < 9.5; x += 0.25) {
      const auto tried = trials.from(x, [](const DigPath&) { return true; });
      const Outcome made = make_dig_path(zx120(), dig, x, ground, options);
      const auto* path = std::get_if<DigPath>(&made);
      ASSERT_EQ(tried.has_value(), path != nullptr) << i << " at " << x;
      if (!path) continue;
      ++drivable;
      ASSERT_EQ(tried->poses.size(), path->poses.size());
      for (std::size_t k = 0; k < path->poses.size(); ++k) {
        ASSERT_EQ(tried->poses[k].joints, path->poses[k].joints);
        ASSERT_EQ(tried->poses[k].bucket.z, path->poses[k].bucket.z);
      }
      EXPECT_EQ(tried->limit_margin.margin, path->limit_margin.margin);
      EXPECT_EQ(tried->heel_clearance, path->heel_clearance);
    }
  }
  EXPECT_GT(drivable, 300);
}

TEST(DigTrials, AreJudgedBeforeTheLift) {
  const DigParameters dig = {0.7, 0.3, 1.5};
  const GroundProfile ground = flat;
  const DigPathOptions options;
  const DigTrials trials(zx120(), dig, ground, options);
  const double x = driven(make_dig_path_anywhere(zx120(), dig, flat)).start_x;
  const auto judge = [](const DigPath& path) { return path.poses.back().phase != DigPhase::scoop; };
  EXPECT_FALSE(trials.from(x, judge));
  EXPECT_TRUE(trials.from(x, [&](const DigPath& path) { return !judge(path); }));
  DigPathOptions wrong;
  wrong.step = 0.0;
  EXPECT_THROW(DigTrials(zx120(), dig, ground, wrong), Error);
}

}  // namespace
}  // namespace excavplan
