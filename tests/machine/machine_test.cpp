// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/kinematics.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include "base/random.hpp"

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using nlohmann::json;
using test::zx120;
using test::zx120_path;

JointAngles random_joints(const Machine& machine, Random& random) {
  JointAngles joints;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    joints[i] = random.uniform(limits.lower, limits.upper);
  }
  return joints;
}

json shipped_json() { return json::parse(std::ifstream(zx120_path())); }

/// What load_machine says about the shipped file after a change.
std::string machine_complaint(const std::function<void(json&)>& change) {
  json file = shipped_json();
  change(file);
  return test::complaint_about_file(file);
}

// ---- published figures --------------------------------------------------------------------------

TEST(Machine, HoldsThePublishedGeometryOfTheZx120) {
  const Machine& m = zx120();
  EXPECT_EQ(m.boom_pin, Vector2d(0.14, 1.424));
  EXPECT_EQ(m.boom_length, 4.6);
  EXPECT_EQ(m.arm_length, 2.519);
  EXPECT_EQ(m.bucket_length, 1.23);
  const double degrees[3][2] = {{-70, 44}, {30, 152}, {-33, 143}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(m.limits[i].lower, degrees[i][0] * pi / 180, 1e-12);
    EXPECT_NEAR(m.limits[i].upper, degrees[i][1] * pi / 180, 1e-12);
  }
  EXPECT_NEAR(m.beta(), 50 * pi / 180, 1e-12);
  EXPECT_NEAR(m.full_length(), 8.349, 1e-12);
}

// Catalogue digging forces: 99 kN at the tip of the bucket, 63 kN with arm and bucket in line.
TEST(Machine, TorqueLimitsAreTheCatalogueDiggingForces) {
  const Machine& m = zx120();
  EXPECT_NEAR(m.limits[2].torque / m.bucket_length, 99e3, 1.0);
  EXPECT_NEAR(m.limits[1].torque / (m.arm_length + m.bucket_length), 63e3, 1.0);
}

TEST(Machine, ReachesThePublishedWorkspace) {
  const Machine& m = zx120();
  double reach = 0, reach_at_ground = 0, depth = 0, height = 0;
  JointAngles joints;
  const auto at = [&](int joint, int i, int count) {
    const JointLimits& limits = m.limits[static_cast<std::size_t>(joint)];
    return limits.lower + (limits.upper - limits.lower) * i / count;
  };
  for (int boom = 0; boom <= 1000; ++boom) {
    for (int arm = 0; arm <= 60; ++arm) {
      for (int bucket = 0; bucket <= 120; ++bucket) {
        joints = {at(0, boom, 1000), at(1, arm, 60), at(2, bucket, 120)};
        const Vector2d tip = link_positions(m, joints).tip;
        reach = std::max(reach, tip.x());
        if (std::abs(tip.y()) < 0.005) reach_at_ground = std::max(reach_at_ground, tip.x());
        depth = std::max(depth, -tip.y());
        height = std::max(height, tip.y());
      }
    }
  }
  EXPECT_NEAR(reach, 8.27, 0.01);
  EXPECT_NEAR(reach_at_ground, 8.15, 0.01);
  EXPECT_NEAR(depth, 5.52, 0.01);
  EXPECT_NEAR(height, 8.54, 0.01);
}

TEST(Machine, BucketHoldsWhatItsMeshHolds) {
  EXPECT_GE(struck_capacity(zx120()), 0.32);
  EXPECT_LE(struck_capacity(zx120()), 0.35);
  EXPECT_GE(heaped_capacity(zx120()), 0.40);
  EXPECT_LE(heaped_capacity(zx120()), 0.43);
  const double area = struck_capacity(zx120()) / zx120().bucket.width_inside;
  EXPECT_GE(area, 0.484);
  EXPECT_LE(area, 0.538);
}

// Five teeth: the bucket mesh of pwri-opera/zx120_ros, and, with their length, the shovel settings
// of pwri-opera/OperaSim-AGX. Width, thickness and angle are ours.
TEST(Machine, BucketHasTheTeethOfThePublishedModels) {
  ASSERT_TRUE(zx120().bucket.teeth.has_value());
  const Teeth& teeth = *zx120().bucket.teeth;
  EXPECT_EQ(teeth.count, 5);
  EXPECT_EQ(teeth.length, 0.15);
  EXPECT_EQ(teeth.width, 0.06);
  EXPECT_EQ(teeth.thickness, 0.045);
  EXPECT_EQ(teeth.angle, 0.3);
  EXPECT_NEAR(teeth.angle, 2 * std::atan(0.5 * teeth.thickness / teeth.length), 0.003);
}

TEST(Machine, CapacityOfASquareBoxIsItsClosedForm) {
  Machine box = zx120();
  box.bucket.profile = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};
  box.bucket.width_inside = 1.0;
  EXPECT_NEAR(struck_capacity(box), 1.0, 1e-15);
  EXPECT_NEAR(heaped_capacity(box), 1.0 + 1.0 / 6.0, 1e-12);  // a pyramid half as high as wide
  EXPECT_NEAR(heaped_capacity(box, 0.0), 1.0, 1e-15);
  box.bucket.width_inside = 3.0;  // the ridge now runs across: a prism and the same pyramid
  EXPECT_NEAR(heaped_capacity(box), 3.0 + 2.0 * 0.25 + 1.0 / 6.0, 1e-12);
}

// ---- kinematics ---------------------------------------------------------------------------------

TEST(Kinematics, ZeroBoomIsLevelAndPositiveAnglesTurnDown) {
  const LinkPositions level = link_positions(zx120(), {0, 0, 0});
  EXPECT_TRUE(level.tip.isApprox(Vector2d(0.14 + 8.349, 1.424), 1e-12));
  const LinkPositions square = link_positions(zx120(), {0, pi / 2, pi / 2});
  EXPECT_TRUE(square.bucket_pin.isApprox(Vector2d(4.74, 1.424 - 2.519), 1e-12));
  EXPECT_TRUE(square.tip.isApprox(Vector2d(4.74 - 1.23, 1.424 - 2.519), 1e-12));
  EXPECT_GT(link_positions(zx120(), {-0.5, 0, 0}).tip.y(), level.tip.y());
}

TEST(Kinematics, FloorAngleIsZeroOnLevelFloorAndPositiveWithRaisedHeel) {
  const Machine& m = zx120();
  const BucketPose pose{5.0, 0.0, 0.3};
  const auto joints = std::get<JointAngles>(inverse_kinematics(m, pose));
  const LinkPositions at = link_positions(m, joints);
  const Vector2d tip_to_heel =
      bucket_point(at, m.bucket.profile[1]) - bucket_point(at, m.bucket.profile[0]);
  EXPECT_NEAR(std::atan2(tip_to_heel.y(), tip_to_heel.x()), 0.3, 1e-12);
  EXPECT_TRUE(bucket_point(at, {m.bucket_length, 0}).isApprox(at.tip, 1e-12));
  EXPECT_NEAR(bucket_point(at, {0, 0}).x(), at.bucket_pin.x(), 1e-15);
}

TEST(Kinematics, RoundTripIsExactOverAMillionPostures) {
  const Machine& m = zx120();
  Random random(1);
  double worst_joint = 0.0, worst_pose = 0.0;
  for (int n = 0; n < 1000000; ++n) {
    const JointAngles joints = random_joints(m, random);
    const BucketPose pose = forward_kinematics(m, joints);
    const auto found = inverse_kinematics(m, pose);
    ASSERT_TRUE(std::holds_alternative<JointAngles>(found)) << joints.transpose();
    const BucketPose again = forward_kinematics(m, std::get<JointAngles>(found));
    worst_joint =
        std::max(worst_joint, (std::get<JointAngles>(found) - joints).cwiseAbs().maxCoeff());
    worst_pose = std::max({worst_pose, std::abs(again.x - pose.x), std::abs(again.z - pose.z),
                           std::abs(std::remainder(again.floor_angle - pose.floor_angle, 2 * pi))});
  }
  EXPECT_LT(worst_joint, 1e-12);
  EXPECT_LT(worst_pose, 1e-12);
}

TEST(Kinematics, RoundTripWithHeldBucketIsExact) {
  const Machine& m = zx120();
  Random random(2);
  for (int n = 0; n < 200000; ++n) {
    JointAngles joints = random_joints(m, random);
    joints[1] = std::min(joints[1], 2.5);  // beyond, a second posture has the elbow above as well
    const Vector2d tip = link_positions(m, joints).tip;
    const auto found = inverse_kinematics_fixed_bucket(m, tip.x(), tip.y(), joints[2]);
    ASSERT_TRUE(std::holds_alternative<JointAngles>(found)) << joints.transpose();
    ASSERT_LT((std::get<JointAngles>(found) - joints).cwiseAbs().maxCoeff(), 1e-12);
    ASSERT_EQ(std::get<JointAngles>(found)[2], joints[2]);
  }
}

TEST(Kinematics, FloorAngleMayBeGivenWithWholeTurnsMore) {
  const Machine& m = zx120();
  const auto plain = std::get<JointAngles>(inverse_kinematics(m, {5.0, 0.0, 0.3}));
  for (const double turns : {-3.0, -1.0, 1.0, 7.0}) {
    const auto turned =
        std::get<JointAngles>(inverse_kinematics(m, {5.0, 0.0, 0.3 + turns * 2 * pi}));
    EXPECT_LT((turned - plain).norm(), 1e-12);
  }
}

TEST(Kinematics, DirectionsBeyondHalfATurnAreWrapped) {
  const Machine& m = zx120();
  const JointAngles curled(0.7, 2.6, 2.4);  // phi3 = -5.7
  const BucketPose pose = forward_kinematics(m, curled);
  EXPECT_LE(std::abs(pose.floor_angle), pi);
  EXPECT_LT((std::get<JointAngles>(inverse_kinematics(m, pose)) - curled).norm(), 1e-12);
}

TEST(Kinematics, SaysHowFarAPoseIsBeyondReach) {
  const Machine& m = zx120();
  const double phi3_level = m.beta();  // floor angle at which the bucket points along +x is pi-beta
  const BucketPose far{m.boom_pin.x() + 10.0, m.boom_pin.y(), pi - phi3_level};
  const auto too_far = std::get<Unreachable>(inverse_kinematics(m, far));
  EXPECT_EQ(too_far.reason, Unreachable::Reason::too_far);
  EXPECT_NEAR(too_far.value, 10.0 - 1.23, 1e-12);
  EXPECT_NEAR(too_far.limit, 4.6 + 2.519, 1e-12);
  EXPECT_NEAR(too_far.excess, 10.0 - 8.349, 1e-12);

  const BucketPose near{m.boom_pin.x() + 1.23 + 0.5, m.boom_pin.y(), pi - phi3_level};
  const auto too_near = std::get<Unreachable>(inverse_kinematics(m, near));
  EXPECT_EQ(too_near.reason, Unreachable::Reason::too_near);
  EXPECT_NEAR(too_near.value, 0.5, 1e-12);
  EXPECT_NEAR(too_near.excess, 4.6 - 2.519 - 0.5, 1e-12);

  const auto held = std::get<Unreachable>(inverse_kinematics_fixed_bucket(m, 20.14, 1.424, 0.0));
  EXPECT_EQ(held.reason, Unreachable::Reason::too_far);
  EXPECT_NEAR(held.excess, 20.0 - 8.349, 1e-12);
}

TEST(Kinematics, NamesTheJointThatIsFurthestOutside) {
  const Machine& m = zx120();
  const double past = 0.05;
  for (int i = 0; i < 3; ++i) {
    for (const bool upper : {false, true}) {
      const JointLimits& limits = m.limits[static_cast<std::size_t>(i)];
      JointAngles joints(-0.3, 1.5, 0.5);
      joints[i] = upper ? limits.upper + past : limits.lower - past;
      const auto found = inverse_kinematics(m, forward_kinematics(m, joints));
      ASSERT_TRUE(std::holds_alternative<Unreachable>(found));
      const auto& failed = std::get<Unreachable>(found);
      EXPECT_EQ(failed.reason, Unreachable::Reason::joint_limit);
      EXPECT_EQ(static_cast<int>(failed.joint), i);
      EXPECT_NEAR(failed.value, joints[i], 1e-12);
      EXPECT_EQ(failed.limit, upper ? limits.upper : limits.lower);
      EXPECT_NEAR(failed.excess, past, 1e-12);
    }
  }
}

TEST(Kinematics, OfTwoJointsOutsideNamesTheWorse) {
  const Machine& m = zx120();
  const JointAngles joints(m.limits[0].upper + 0.2, 1.5, m.limits[2].upper + 0.1);
  const auto failed = std::get<Unreachable>(inverse_kinematics(m, forward_kinematics(m, joints)));
  EXPECT_EQ(failed.joint, Joint::boom);
  EXPECT_NEAR(failed.excess, 0.2, 1e-12);
}

TEST(Kinematics, PosturesExactlyOnTheLimitsCanBeHeld) {
  const Machine& m = zx120();
  for (int corner = 0; corner < 8; ++corner) {
    JointAngles joints;
    for (int i = 0; i < 3; ++i) {
      const JointLimits& limits = m.limits[static_cast<std::size_t>(i)];
      joints[i] = (corner >> i) & 1 ? limits.upper : limits.lower;
    }
    const auto found = inverse_kinematics(m, forward_kinematics(m, joints));
    ASSERT_TRUE(std::holds_alternative<JointAngles>(found)) << joints.transpose();
    EXPECT_GE(limit_margin(m, std::get<JointAngles>(found)).margin, 0.0);
    EXPECT_LT((std::get<JointAngles>(found) - joints).norm(), 1e-11);
  }
}

TEST(Kinematics, StraightAndFoldedArmAreAnswered) {
  Machine m = zx120();
  m.limits[1].lower = 0.0;
  m.limits[1].upper = pi;
  for (const double arm : {0.0, 1e-13, pi - 1e-13, pi}) {
    const BucketPose pose = forward_kinematics(m, {0.1, arm, 0.4});
    const auto found = inverse_kinematics(m, pose);
    ASSERT_TRUE(std::holds_alternative<JointAngles>(found)) << arm;
    const BucketPose again = forward_kinematics(m, std::get<JointAngles>(found));
    EXPECT_NEAR(again.x, pose.x, 1e-7);  // the square root of rounding: the posture is singular
    EXPECT_NEAR(again.z, pose.z, 1e-7);
  }
}

TEST(Kinematics, HostilePosesAreAnsweredAsUnreachable) {
  const Machine& m = zx120();
  for (const double bad : {nan, infinity, -infinity, 1e9, -1e9, 1e200, 1.7e308}) {
    for (const BucketPose& pose : {BucketPose{bad, 0, 0}, BucketPose{5, bad, 0}}) {
      const auto found = inverse_kinematics(m, pose);
      ASSERT_TRUE(std::holds_alternative<Unreachable>(found)) << bad;
      EXPECT_EQ(std::get<Unreachable>(found).reason, Unreachable::Reason::too_far) << bad;
      EXPECT_GT(std::get<Unreachable>(found).excess, 0.0) << bad;
      const auto held = inverse_kinematics_fixed_bucket(m, pose.x, pose.z, 0.5);
      ASSERT_TRUE(std::holds_alternative<Unreachable>(held)) << bad;
    }
  }
  for (const double bad : {nan, infinity, -infinity}) {
    const auto found = inverse_kinematics(m, {5, 0, bad});
    ASSERT_TRUE(std::holds_alternative<Unreachable>(found));
    EXPECT_EQ(std::get<Unreachable>(found).reason, Unreachable::Reason::too_far);
    EXPECT_TRUE(std::holds_alternative<Unreachable>(inverse_kinematics_fixed_bucket(m, 5, 0, bad)));
  }
}

TEST(Kinematics, LimitMarginIsTheSmallestDistanceToALimit) {
  const Machine& m = zx120();
  const LimitMargin inside = limit_margin(m, {0.0, m.limits[1].lower + 0.1, 0.5});
  EXPECT_NEAR(inside.margin, 0.1, 1e-12);
  EXPECT_EQ(inside.joint, Joint::arm);
  const LimitMargin outside = limit_margin(m, {0.0, 1.5, m.limits[2].upper + 0.2});
  EXPECT_NEAR(outside.margin, -0.2, 1e-12);
  EXPECT_EQ(outside.joint, Joint::bucket);
}

// ---- torques ------------------------------------------------------------------------------------

double potential_energy(const Machine& m, const JointAngles& joints) {
  const LinkPositions at = link_positions(m, joints);
  const Vector2d pins[3] = {m.boom_pin, at.arm_pin, at.bucket_pin};
  const double angles[3] = {at.phi1, at.phi2, at.phi3};
  double energy = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double z = pins[i].y() + m.links[i].along * std::sin(angles[i]) +
                     m.links[i].across * std::cos(angles[i]);
    energy += m.links[i].mass * 9.80665 * z;
  }
  return energy;
}

TEST(Torque, HoldingTheLinksIsTheSlopeOfTheirPotentialEnergy) {
  const Machine& m = zx120();
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const JointAngles joints = random_joints(m, random);
    const JointAngles torque = torque_against_link_weight(m, link_positions(m, joints));
    for (int i = 0; i < 3; ++i) {
      const JointAngles step = 1e-5 * JointAngles::Unit(i);
      const double slope =
          (potential_energy(m, joints + step) - potential_energy(m, joints - step)) / 2e-5;
      ASSERT_NEAR(torque[i], slope, 1e-2);
    }
  }
}

TEST(Torque, HoldingABoomThatReachesOutPullsItUp) {
  const JointAngles torque =
      torque_against_link_weight(zx120(), link_positions(zx120(), {0, 0, 0}));
  const double boom = 992 * 2.03 + 392 * (4.6 + 0.59) + 386 * (4.6 + 2.519 + 0.5);
  EXPECT_NEAR(torque[0], -9.80665 * boom, 1e-6);
  EXPECT_NEAR(torque[2], -9.80665 * 386 * 0.5, 1e-9);
}

TEST(Torque, DoesTheWorkOfTheForceItHolds) {
  const Machine& m = zx120();
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const JointAngles joints = random_joints(m, random);
    const Vector2d on_bucket(random.uniform(-1, 2), random.uniform(-1, 1));
    const Vector2d force(random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4));
    const LinkPositions at = link_positions(m, joints);
    const JointAngles torque = torque_against_force(m, at, bucket_point(at, on_bucket), force);
    for (int i = 0; i < 3; ++i) {
      const JointAngles step = 1e-5 * JointAngles::Unit(i);
      const Vector2d moved = bucket_point(link_positions(m, joints + step), on_bucket) -
                             bucket_point(link_positions(m, joints - step), on_bucket);
      ASSERT_NEAR(torque[i], -force.dot(moved) / 2e-5, 1e-3);
    }
  }
}

// ---- the file -----------------------------------------------------------------------------------

void expect_sources(const json& object, const json& sources, const std::string& where) {
  for (const auto& [key, value] : object.items()) {
    if (key == "sources" || key == "description") continue;
    if (value.is_object()) {
      expect_sources(value, value.value("sources", sources), where + key + ".");
    } else {
      EXPECT_TRUE(sources.contains(key)) << where << key << " has no source";
    }
  }
}

TEST(MachineFile, EveryNumberHasASource) {
  json file = shipped_json();
  for (const char* key : {"format", "version", "name"}) file.erase(key);
  expect_sources(file, json::object(), "");
}

/// What is said about the shipped file with one value changed.
std::string set(const char* pointer, const json& value) {
  return machine_complaint([&](json& f) { f[json::json_pointer(pointer)] = value; });
}

TEST(MachineFile, NamesKeyValueAndRuleOfWhatItRefuses) {
  EXPECT_EQ(machine_complaint([](json&) {}), "no error");
  EXPECT_EQ(set("/geometry/boom_length_m", 0.0),
            "geometry.boom_length_m: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("/geometry/arm_length_m", -2.5),
            "geometry.arm_length_m: is -2.5, must be above 0 and at most 100");
  EXPECT_EQ(set("/geometry/bucket_length_m", 1230),
            "geometry.bucket_length_m: is 1230, must be above 0 and at most 100");
  EXPECT_EQ(set("/geometry/boom_pin_m/1", 1e6),
            "geometry.boom_pin_m: is further than 100 m from the origin");
  EXPECT_EQ(set("/joints/boom/upper_rad", -1.5),
            "joints.boom.upper_rad: is -1.5, must be above lower_rad = -1.2217304763960306");
  EXPECT_EQ(
      set("/joints/arm/lower_rad", -0.1).rfind("joints.arm.lower_rad: is -0.1, must be in 0", 0),
      0u);
  EXPECT_EQ(set("/joints/bucket/speed_rad_per_s", 0),
            "joints.bucket.speed_rad_per_s: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("/joints/bucket/torque_n_m", -1),
            "joints.bucket.torque_n_m: is -1, must be above 0 and at most 1e+09");
  EXPECT_EQ(set("/joints/bucket/torque_n_m", "much"),
            "joints.bucket.torque_n_m: is \"much\", expected a number");
  EXPECT_EQ(set("/links/arm/mass_kg", 0),
            "links.arm.mass_kg: is 0, must be above 0 and at most 1e+06");
  EXPECT_EQ(set("/bucket/width_inside_m", 0.8),
            "bucket.width_inside_m: is 0.8, must not exceed width_outside_m = 0.7");
  EXPECT_EQ(set("/bucket/profile/0/along_m", 1.2),
            "bucket.profile: begins at (1.2, 0), must begin at the tip (1.23, 0)");
  EXPECT_EQ(set("/bucket/profile/2/across_m", 0.5),
            "bucket.profile: must be convex and run counter-clockwise");
  EXPECT_EQ(set("/bucket/color", "orange"), "bucket.color: is not a key of this file");
  EXPECT_EQ(set("/format", "excavplan-soil"),
            "format: is 'excavplan-soil', expected 'excavplan-machine'");
  EXPECT_EQ(machine_complaint([](json& f) { f["links"].erase("boom"); }), "links.boom: is missing");
}

TEST(MachineFile, MayStateTheWidthOfTheTracks) {
  const Machine stated = zx120();
  EXPECT_EQ(stated.undercarriage_width(), 2.6);
  json file = shipped_json();
  file["geometry"].erase("track_width_m");
  const std::string path = testing::TempDir() + "tracks_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const Machine silent = load_machine(path);
  EXPECT_FALSE(silent.track_width);
  EXPECT_EQ(fingerprint(silent), fingerprint(stated)) << "it affects no dig";
  EXPECT_EQ(set("/geometry/track_width_m", 2.4), "no error");
  EXPECT_EQ(set("/geometry/track_width_m", 0.0),
            "geometry.track_width_m: is 0, must be above 0 and at most 100");
  std::remove(path.c_str());
}

TEST(MachineFile, MayStateTheRadiusOfTheTail) {
  Machine machine = zx120();
  EXPECT_EQ(machine.tail_swing_radius(), 2.13);
  machine.tail_radius.reset();
  EXPECT_NEAR(machine.tail_swing_radius(), 1.35 * 1.8, 1e-12);
  EXPECT_EQ(fingerprint(machine), fingerprint(zx120())) << "it affects no dig";
  EXPECT_EQ(set("/geometry/tail_radius_m", 2.4), "no error");
  EXPECT_EQ(set("/geometry/tail_radius_m", 0.0),
            "geometry.tail_radius_m: is 0, must be above 0 and at most 100");
}

TEST(MachineFile, MayNameSomeOfTheRobotsJoints) {
  json file = shipped_json();
  file["robot_joints"] = {{"boom", {{"name", "b"}}}, {"arm", {{"sign", -1}}}};
  const std::string path = testing::TempDir() + "joints_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const RobotJoints joints = load_machine(path).robot_joints;
  EXPECT_EQ(joints[0].name, "b");
  EXPECT_EQ(joints[1].name, "arm");
  EXPECT_EQ(joints[1].sign, -1.0);
  EXPECT_EQ(joints[2].name, "bucket");
  EXPECT_EQ(joints[3].name, "swing");
  EXPECT_EQ(set("/robot_joints/swing/name", ""), "no error");
  EXPECT_EQ(set("/robot_joints/arm/name", ""),
            "robot_joints.arm.name: is empty; boom, arm and bucket must have a name");
  EXPECT_EQ(set("/robot_joints/arm", {{"name", "bucket_joint"}}),
            "robot_joints.bucket: has the name 'bucket_joint' of arm");
  std::remove(path.c_str());
}

TEST(MachineFile, MayLeaveOutTheTeeth) {
  json file = shipped_json();
  file["bucket"].erase("teeth");
  const std::string path = testing::TempDir() + "plain_lip_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  EXPECT_FALSE(load_machine(path).bucket.teeth.has_value());
  std::remove(path.c_str());
}

TEST(MachineFile, NamesKeyValueAndRuleOfTeethItRefuses) {
  const auto set = [](const std::string& key, const json& value) {
    return machine_complaint([&](json& f) { f["bucket"]["teeth"][key] = value; });
  };
  for (const auto& [value, text] :
       std::vector<std::pair<json, std::string>>{{0, "0"}, {-5, "-5"}, {2.5, "2.5"}, {51, "51"}}) {
    EXPECT_EQ(set("count", value),
              "bucket.teeth.count: is " + text + ", must be a whole number in 1 .. 50");
  }
  EXPECT_EQ(set("count", "five"), "bucket.teeth.count: is \"five\", expected a number");
  EXPECT_EQ(set("width_m", 0), "bucket.teeth.width_m: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("width_m", 0.14), "no error");  // shoulder to shoulder
  EXPECT_EQ(set("width_m", 0.15),
            "bucket.teeth.width_m: is 0.15, 5 teeth must not exceed width_outside_m = 0.7");
  EXPECT_EQ(set("thickness_m", -0.045),
            "bucket.teeth.thickness_m: is -0.045, must be above 0 and at most 1");
  EXPECT_EQ(set("length_m", 150), "bucket.teeth.length_m: is 150, must be above 0 and at most 1");
  for (const double angle : {0.0, -0.3, pi / 2, 2.0}) {
    EXPECT_EQ(set("angle_rad", angle).rfind("bucket.teeth.angle_rad: is ", 0), 0u) << angle;
  }
  EXPECT_EQ(set("angle_rad", 2),
            "bucket.teeth.angle_rad: is 2, must be above 0 and below 1.5707963267948966");
  EXPECT_EQ(set("color", "grey"), "bucket.teeth.color: is not a key of this file");
  EXPECT_EQ(machine_complaint([](json& f) { f["bucket"]["teeth"].erase("length_m"); }),
            "bucket.teeth.length_m: is missing");
}

TEST(MachineFile, MayLimitTheSwing) {
  json file = shipped_json();
  file["swing"].update({{"lower_rad", -1.0}, {"upper_rad", 2.0}, {"acceleration_rad_per_s2", 0.5}});
  const std::string path = testing::TempDir() + "swing_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const Machine machine = load_machine(path);
  std::remove(path.c_str());
  EXPECT_EQ(machine.swing->lower, -1.0);
  EXPECT_EQ(machine.swing->upper, 2.0);
  EXPECT_EQ(machine.swing->acceleration, 0.5);
  EXPECT_FALSE(machine.swing->turns_round());
  EXPECT_TRUE(zx120().swing->turns_round());
  EXPECT_NE(fingerprint(machine), fingerprint(zx120())) << "a cycle takes longer";
  EXPECT_EQ(set("/swing/lower_rad", -1.0), "swing.upper_rad: is missing");
  EXPECT_EQ(set("/swing/acceleration_rad_per_s2", 0.0),
            "swing.acceleration_rad_per_s2: is 0, must be above 0 and at most 10000");
  EXPECT_EQ(
      set("/swing/acceleration_rad_per_s2", 20.0),
      "swing.acceleration_rad_per_s2: is 20, must be in 0.01 .. 5: is it in degrees or turns?");
  EXPECT_EQ(machine_complaint([](json& f) {
              f["swing"].update({{"lower_rad", 1.0}, {"upper_rad", -1.0}});
            }),
            "swing.upper_rad: is -1, must be above lower_rad = 1");
}

TEST(MachineFile, OfTheZx200HasThePublishedAccelerationOfItsSwing) {
  EXPECT_EQ(load_machine(find_data_file("machines/zx200.json")).swing->acceleration, 0.35);
}

TEST(MachineFile, MayPlaceTheRootOfTheRobot) {
  json file = shipped_json();
  file["robot_root"] = {{"position_m", {0.5, -1.0, 0.25}}, {"yaw_rad", pi / 2.0}};
  const std::string path = testing::TempDir() + "root_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const Machine machine = load_machine(path);
  std::remove(path.c_str());
  const Eigen::Vector3d moved = machine.site_from_root * Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_LT((moved - Eigen::Vector3d(0.5, 1.0, 0.25)).norm(), 1e-12);
  EXPECT_EQ(fingerprint(machine), fingerprint(zx120()));
  EXPECT_EQ(set("/robot_root/position_m", json::array({0, 0, 1e3})),
            "robot_root.position_m: is further than 100 m from the origin");
}

TEST(MachineFile, MayLeaveOutBodySwingAndEngine) {
  json file = shipped_json();
  for (const char* key : {"body", "swing", "engine"}) file.erase(key);
  const std::string path = testing::TempDir() + "bare_" + std::to_string(::getpid()) + ".json";
  std::ofstream(path) << file;
  const Machine machine = load_machine(path);
  EXPECT_FALSE(machine.body || machine.swing || machine.engine);
  EXPECT_NE(fingerprint(machine), fingerprint(zx120()));
  std::remove(path.c_str());
}

TEST(MachineFile, NamesKeyValueAndRuleOfABodyItRefuses) {
  const auto set = [](const char* pointer, const json& value) {
    return machine_complaint([&](json& f) { f["body"][json::json_pointer(pointer)] = value; });
  };
  const std::string edges = ", must lie between rear_edge_m = -1.44 and front_edge_m = 1.44";
  EXPECT_EQ(set("/mass_kg", 0), "body.mass_kg: is 0, must be above 0 and at most 1e+06");
  EXPECT_EQ(set("/center_m/1", 0),
            "body.center_m: has its z at 0, must be above 0 and at most 100");
  EXPECT_EQ(set("/center_m/0", 1.44), "body.center_m: has its x at 1.44" + edges);
  EXPECT_EQ(set("/center_m/0", -1.5), "body.center_m: has its x at -1.5" + edges);
  EXPECT_EQ(set("/rear_edge_m", 2),
            "body.center_m: has its x at -0.58, must lie between rear_edge_m = 2 and "
            "front_edge_m = 1.44");
  EXPECT_EQ(set("/front_edge_m", 1.8), "no error");  // as far as the tracks
  EXPECT_EQ(set("/front_edge_m", 1.81).rfind("body.front_edge_m: is 1.81, must be in -100", 0), 0u);
  EXPECT_EQ(set("/track_friction", -0.6),
            "body.track_friction: is -0.6, must be above 0 and at most 2");
  EXPECT_EQ(set("/width_m", 2.5), "body.width_m: is not a key of this file");
}

TEST(MachineFile, NamesKeyValueAndRuleOfSwingAndEngineItRefuses) {
  EXPECT_EQ(set("/swing/speed_rad_per_s", 0),
            "swing.speed_rad_per_s: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("/swing/torque_n_m", -1),
            "swing.torque_n_m: is -1, must be above 0 and at most 1e+09");
  EXPECT_EQ(set("/swing/inertia_kg_m2", 0),
            "swing.inertia_kg_m2: is 0, must be above 0 and at most 1e+09");
  EXPECT_EQ(set("/engine/power_w", 0), "engine.power_w: is 0, must be above 0 and at most 1e+08");
  EXPECT_EQ(set("/engine/idle_power_w", 0), "no error");
  EXPECT_EQ(set("/engine/idle_power_w", -1).rfind("engine.idle_power_w: is -1, must be in 0", 0),
            0u);
}

TEST(MachineFile, RefusesNumbersInOtherUnits) {
  EXPECT_EQ(set("/engine/power_w", 63.8),
            "engine.power_w: is 63.8, 0.0360 W per kg of boom, arm and bucket, must be in 2 .. "
            "1000: is it in kW?");
  EXPECT_EQ(set("/engine/idle_power_w", 70000),
            "engine.idle_power_w: is 70000, 1.10 of power_w, must be in 0 .. 1: an idling engine "
            "takes less than it can give");
  EXPECT_EQ(set("/geometry/boom_pin_m/1", -1.424),
            "geometry.boom_pin_m[1]: is -1.424, -0.310 of boom_length_m above the ground, must be "
            "in 0.01 .. 2: the ground that the machine stands on is z = 0");
  EXPECT_EQ(set("/joints/boom/speed_rad_per_s", 25.8),
            "joints.boom.speed_rad_per_s: is 25.8, must be in 0.01 .. 5: is it in degrees or "
            "turns?");
  const std::pair<const char*, double> others[] = {
      {"/swing/torque_n_m", 34},        {"/swing/inertia_kg_m2", 15},
      {"/swing/speed_rad_per_s", 14.3}, {"/joints/arm/torque_n_m", 236},
      {"/links/arm/mass_kg", 0.392},    {"/body/mass_kg", 10.93}};
  for (const auto& [pointer, value] : others) {
    std::string key = std::string(pointer).substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    const std::string complaint = set(pointer, value);
    EXPECT_EQ(complaint.rfind(key + ": is ", 0), 0u) << complaint;
    EXPECT_NE(complaint.find(": is it in "), std::string::npos) << complaint;
  }
}

/// Of a machine of other size and the same shape, whose links weigh as much of its torques.
void scale(json& value, const std::string& key, double size) {
  const std::pair<const char*, double> powers[] = {
      {"_kg_m2", 5}, {"_n_m", 4}, {"_m3_per_s", 2.5}, {"_rad_per_s", -0.5},
      {"_w", 3},     {"_kg", 3},  {"_m", 1}};
  if (value.is_object()) {
    for (auto& [name, member] : value.items()) scale(member, name, size);
  } else if (value.is_array()) {
    for (json& member : value) scale(member, key, size);
  } else if (value.is_number()) {
    for (const auto& [end, power] : powers) {
      const std::size_t length = std::string(end).size();
      if (key.size() <= length || key.substr(key.size() - length) != end) continue;
      value = value.get<double>() * std::pow(size, power);
      return;
    }
  }
}

TEST(MachineFile, OfOneToAHundredTonnesAreTaken) {
  for (const double tonnes : {0.8, 3.0, 12.7, 40.0, 120.0}) {
    const double size = std::cbrt(tonnes / 12.7);
    EXPECT_EQ(machine_complaint([&](json& f) { scale(f, "", size); }), "no error") << tonnes;
  }
}

TEST(Machine, FingerprintDependsOnBodySwingAndEngine) {
  const std::function<void(Machine&)> changes[] = {[](Machine& m) { m.body->mass += 1.0; },
                                                   [](Machine& m) { m.body->centre.x() += 0.01; },
                                                   [](Machine& m) { m.body->centre.y() += 0.01; },
                                                   [](Machine& m) { m.body->rear_edge += 0.01; },
                                                   [](Machine& m) { m.body->front_edge += 0.01; },
                                                   [](Machine& m) { m.body->track_friction += 0.01; },
                                                   [](Machine& m) { m.swing->speed += 0.01; },
                                                   [](Machine& m) { m.swing->torque += 1.0; },
                                                   [](Machine& m) { m.swing->inertia += 1.0; },
                                                   [](Machine& m) { m.engine->power += 1.0; },
                                                   [](Machine& m) { m.engine->idle_power += 1.0; }};
  std::set<std::string> seen = {fingerprint(zx120())};
  for (const auto& change : changes) {
    Machine machine = zx120();
    change(machine);
    EXPECT_TRUE(seen.insert(fingerprint(machine)).second);
  }
}

TEST(MachineFile, RefusesProfilesThatAreNoConvexPolygon) {
  const auto with_profile = [](const std::vector<Vector2d>& corners) {
    return machine_complaint([&](json& f) {
      f["bucket"]["profile"] = json::array();
      for (const Vector2d& c : corners) {
        f["bucket"]["profile"].push_back({{"along_m", c.x()}, {"across_m", c.y()}});
      }
    });
  };
  const std::string not_convex = "bucket.profile: must be convex and run counter-clockwise";
  EXPECT_EQ(with_profile({{1.23, 0}, {0.1, 0.1}}),
            "bucket.profile: has 2 corners, must have 3 .. 1000");
  EXPECT_EQ(with_profile({{1.23, 0}, {0.1, 0}, {0.8, 0.5}}), not_convex);            // clockwise
  EXPECT_EQ(with_profile({{1.23, 0}, {0.8, 0}, {0.1, 0}}), not_convex);              // a line
  EXPECT_EQ(with_profile({{1.23, 0}, {0.8, 0.5}, {0.8, 0.5}, {0, 0}}), not_convex);  // twice
  // All its corners turn left, but it goes round twice.
  EXPECT_EQ(with_profile({{1.23, 0}, {-0.8, 0.6}, {0.4, -0.9}, {0.4, 0.9}, {-0.8, -0.6}}),
            not_convex);
  EXPECT_EQ(
      with_profile({{1.23, 0}, {1.4, -0.1}, {0.5, 0.5}}),
      "bucket.profile: has its heel at across_m = -0.1, must be above 0, the line from bucket "
      "pin to tip");
}

}  // namespace
}  // namespace excavplan
