// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/cylinders.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/kinematics.hpp>
#include "base/random.hpp"

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using nlohmann::json;
using test::zx120;
using test::zx120_path;

const Cylinder& cylinder(std::size_t joint) { return zx120().cylinders.value()[joint]; }

/// A joint angle of the machine: 0 lower limit, 1 upper.
double within(std::size_t joint, double share) {
  const JointLimits& limits = zx120().limits[joint];
  return limits.lower + share * (limits.upper - limits.lower);
}

PolarPin polar(const Vector2d& pin, const Vector2d& link) {
  const double angle = std::atan2(pin.y(), pin.x()) - std::atan2(link.y(), link.x());
  return {pin.norm(), std::remainder(angle, 2.0 * pi)};
}

/// The bucket's cylinder on the pins of the meshes of pwri-opera/zx120_ros.
Cylinder mesh_bucket_cylinder() {
  const Vector2d bucket_pin(0.35383, -2.4712), tip(-0.8545, 0.892);
  CylinderGeometry geometry;
  geometry.foot = polar(Vector2d(0.605825, -0.364793) - bucket_pin, bucket_pin);
  geometry.rod = FourBar{{polar(Vector2d(0.330489, -2.150643) - bucket_pin, bucket_pin), 0.492},
                         {polar(Vector2d(-0.182145, -0.315076), tip), 0.465}};
  return Cylinder(geometry, -33 * degree, 143 * degree);
}

struct Row {
  double degrees, length, lever;
};

std::string complaint_of(const CylinderGeometry& geometry, double lower, double upper) {
  return test::error_of([&] { Cylinder(geometry, lower, upper); });
}

/// What load_machine says about the shipped file after a change.
std::string complaint_about(const std::function<void(json&)>& change) {
  json file = json::parse(std::ifstream(zx120_path()));
  change(file["cylinders"]);
  return test::complaint_about_file(file);
}

// ---- closed forms -------------------------------------------------------------------------------

TEST(Cylinder, OfARightTriangleIsPythagoras) {
  const CylinderGeometry geometry = {1, {3.0, 0.5 * pi}, PolarPin{4.0, 0.0}};
  const Cylinder square(geometry, -0.5, 0.5);
  EXPECT_NEAR(square.at(0.0).length, 5.0, 1e-15);
  EXPECT_NEAR(square.at(0.0).lever, 3.0 * 4.0 / 5.0, 1e-15);  // height over the hypotenuse
  EXPECT_NEAR(square.joint_angle(5.0).value(), 0.0, 1e-15);
}

// Bucket pin and rocker pin, and both their bars, as a parallelogram: the rocker turns as the
// bucket does, and the cylinder pushes it as it would a plain lever.
TEST(Cylinder, OnAParallelogramPushesTheBucketAsItsRocker) {
  const PolarPin rocker_pin = {0.4, pi};
  const CylinderGeometry linkage = {
      1, {2.0, pi}, FourBar{{rocker_pin, 0.3}, {{0.3, 0.5 * pi}, 0.4}}};
  const CylinderGeometry lever = {1, {1.6, pi}, PolarPin{0.3, 0.5 * pi}};
  const Cylinder four_bar(linkage, -0.6, 0.6);
  const Cylinder plain(lever, -0.6, 0.6);
  for (double joint = -0.6; joint <= 0.6; joint += 0.05) {
    EXPECT_NEAR(four_bar.at(joint).length, plain.at(joint).length, 1e-14);
    EXPECT_NEAR(four_bar.at(joint).lever, plain.at(joint).lever, 1e-14);
  }
}

// The driver of the real machine (zx120_bringup/src/bucket_fix_js_publisher.cpp) has the bucket's
// angle from the rocker's by the law of cosines, counted from the line bucket pin - rocker pin.
TEST(Cylinder, FourBarAgreesWithTheFormulaOfTheMachinesDriver) {
  const double l1 = 0.505, l2 = 0.460, l3 = 0.325, l4 = 0.362;
  const PolarPin foot = {2.1214, 2.8803};
  const auto at = [](double distance, double angle) {
    return Vector2d(distance * std::cos(angle), distance * std::sin(angle));
  };
  for (double th_a = 0.9; th_a <= 2.2; th_a += 0.05) {
    const double lx = std::sqrt(l3 * l3 + l1 * l1 - 2 * l1 * l3 * std::cos(th_a));
    const double alpha = std::acos((l3 - l1 * std::cos(th_a)) / lx);
    const double beta = std::acos(
        (l3 * l3 + l1 * l1 - l2 * l2 + l4 * l4 - 2 * l1 * l3 * std::cos(th_a)) / (2 * l4 * lx));
    const double from_rocker_line = -pi + alpha + beta + 1.865827;
    const double joint = from_rocker_line + (pi - 3.0715);
    const Vector2d rod = at(l3, 3.0715) + at(l1, 3.0715 + pi + th_a);
    ASSERT_NEAR(cylinder(2).at(joint).length, (rod - at(foot.distance, foot.angle)).norm(), 1e-12)
        << th_a;
  }
}

// ---- published figures --------------------------------------------------------------------------

// Lengths and levers over the pins of the meshes (pwri-opera/zx120_ros, OperaSim-AGX). Boom and
// arm have the same pins here; the table gives the boom's elevation and a positive lever.
TEST(Zx120Cylinders, OfBoomAndArmAreThoseOfTheMeshes) {
  for (const Row& row : {Row{70, 2.349, 0.291}, Row{45, 2.193, 0.415}, Row{15, 1.952, 0.488},
                         Row{0, 1.825, 0.481}, Row{-30, 1.600, 0.348}, Row{-44, 1.529, 0.228}}) {
    const CylinderState state = cylinder(0).at(-row.degrees * degree);
    EXPECT_NEAR(state.length, row.length, 6e-4) << row.degrees;
    EXPECT_NEAR(state.lever, -row.lever, 6e-4) << row.degrees;
  }
  for (const Row& row : {Row{30, 1.614, 0.394}, Row{60, 1.896, 0.636}, Row{75, 2.067, 0.666},
                         Row{90, 2.240, 0.648}, Row{120, 2.549, 0.513}, Row{152, 2.773, 0.279}}) {
    const CylinderState state = cylinder(1).at(row.degrees * degree);
    EXPECT_NEAR(state.length, row.length, 6e-4) << row.degrees;
    EXPECT_NEAR(state.lever, row.lever, 6e-4) << row.degrees;
  }
}

// The four-bar of the real machine differs from the meshes' by up to 13 mm: a centimetre in length,
// 3 % in lever but where the bucket is wide open and the lever changes steeply (13 %).
TEST(Zx120Cylinders, OfTheBucketIsThatOfTheMeshesButForTheRealFourBar) {
  const Cylinder mesh = mesh_bucket_cylinder();
  for (const Row& row : {Row{-33, 1.338, 0.166}, Row{0, 1.498, 0.360}, Row{30, 1.700, 0.393},
                         Row{60, 1.895, 0.339}, Row{90, 2.049, 0.246}, Row{143, 2.205, 0.105}}) {
    const double joint = row.degrees * degree;
    EXPECT_NEAR(mesh.at(joint).length, row.length, 1e-3) << row.degrees;
    EXPECT_NEAR(mesh.at(joint).lever, row.lever, 1e-3) << row.degrees;
    EXPECT_NEAR(cylinder(2).at(joint).length, row.length, 0.010) << row.degrees;
    const double tolerance = row.degrees < 0 ? 0.021 : 0.03 * row.lever;
    EXPECT_NEAR(cylinder(2).at(joint).lever, row.lever, tolerance) << row.degrees;
  }
  EXPECT_NEAR(mesh.stroke(), 0.867, 1e-3);
}

TEST(Zx120Cylinders, HaveThePublishedStrokes) {
  EXPECT_NEAR(cylinder(0).stroke(), 0.820, 1e-3);
  EXPECT_NEAR(cylinder(1).stroke(), 1.159, 1e-3);
  EXPECT_NEAR(cylinder(2).stroke(), 0.867, 0.010);
  EXPECT_EQ(cylinder(0).count(), 2);
  EXPECT_EQ(cylinder(1).count(), 1);
  EXPECT_EQ(cylinder(2).count(), 1);
}

// At its best lever each cylinder makes the catalogue's digging force with a force that a cylinder
// of this class can have.
TEST(Zx120Cylinders, PushAsHardAsTheDiggingForcesImply) {
  const double published[3] = {410e3, 355e3, 310e3};
  for (std::size_t j = 0; j < 3; ++j) {
    double least = infinity;
    for (int i = 0; i <= 1000; ++i) {
      const double force = cylinder(j).force(within(j, i / 1000.0), zx120().limits[j].torque);
      least = std::min(least, std::abs(force));
    }
    EXPECT_NEAR(least, published[j], 0.01 * published[j]) << name(static_cast<Joint>(j));
  }
}

TEST(Zx120Cylinders, LiftTheBoomAndCurlArmAndBucketByPushing) {
  const JointAngles joints(-0.3, 1.5, 0.5);
  const Vector3d force = cylinder_forces(*zx120().cylinders, joints, {-1e5, 1e5, 1e5});
  EXPECT_GT(force.minCoeff(), 0.0);
  const LinkPositions at = link_positions(zx120(), joints);
  const JointAngles hold = torque_against_link_weight(zx120(), at);
  EXPECT_GT(cylinder_forces(*zx120().cylinders, joints, hold)[0], 0.0);  // stands on its cylinders
}

// ---- properties ---------------------------------------------------------------------------------

TEST(Zx120Cylinders, LeverIsTheDerivativeOfTheLength) {
  const double h = 1e-5;
  for (std::size_t j = 0; j < 3; ++j) {
    for (int i = 0; i <= 1000; ++i) {
      const double joint = within(j, i / 1000.0);
      const Cylinder& c = cylinder(j);
      const double slope = (c.at(joint + h).length - c.at(joint - h).length) / (2.0 * h);
      ASSERT_NEAR(c.at(joint).lever, slope, 1e-8) << j << " " << joint;
    }
  }
}

TEST(Zx120Cylinders, RoundTripIsExactOverTheWholeRange) {
  double worst = 0.0;
  for (std::size_t j = 0; j < 3; ++j) {
    for (int i = 0; i <= 100000; ++i) {
      const double joint = within(j, i / 100000.0);
      const std::optional<double> back = cylinder(j).joint_angle(cylinder(j).at(joint).length);
      ASSERT_TRUE(back) << j << " " << joint;
      worst = std::max(worst, std::abs(*back - joint));
    }
  }
  EXPECT_LT(worst, 1e-13);
}

TEST(Zx120Cylinders, RiseOrFallAllTheWay) {
  for (std::size_t j = 0; j < 3; ++j) {
    const double sense = j == 0 ? -1.0 : 1.0;
    double last = cylinder(j).at(within(j, 0.0)).length;
    for (int i = 1; i <= 10000; ++i) {
      const double length = cylinder(j).at(within(j, i / 10000.0)).length;
      ASSERT_GT(sense * (length - last), 0.0) << j << " " << i;
      last = length;
    }
  }
}

TEST(Zx120Cylinders, GiveThePowerThatTheJointTakes) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    JointAngles joints;
    Vector3d torque, rate;
    for (int j = 0; j < 3; ++j) {
      joints[j] = within(static_cast<std::size_t>(j), random.uniform(0.01, 0.99));
      torque[j] = random.uniform(-1e5, 1e5);
      rate[j] = random.uniform(-1.0, 1.0);
    }
    const Vector3d force = cylinder_forces(*zx120().cylinders, joints, torque);
    const double h = 1e-5;
    const auto before = cylinder_states(*zx120().cylinders, joints - h * rate);
    const auto after = cylinder_states(*zx120().cylinders, joints + h * rate);
    for (int j = 0; j < 3; ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double speed = (after[i].length - before[i].length) / (2.0 * h);
      ASSERT_NEAR(cylinder(i).count() * force[j] * speed, torque[j] * rate[j], 1e-2);
    }
  }
}

// Any four-bar that is accepted is right: the parts have their lengths, and length and joint angle
// determine each other.
TEST(Cylinder, WhatIsAcceptedIsOneToOne) {
  Random random(4);
  int accepted = 0;
  for (int n = 0; n < 1000; ++n) {
    CylinderGeometry geometry;
    geometry.foot = {random.uniform(1.0, 2.5), random.uniform(-pi, pi)};
    geometry.rod =
        FourBar{{{random.uniform(0.2, 0.6), random.uniform(-pi, pi)}, random.uniform(0.3, 0.7)},
                {{random.uniform(0.2, 0.6), random.uniform(-pi, pi)}, random.uniform(0.3, 0.7)}};
    const double lower = random.uniform(-1.0, 0.0);
    const double upper = lower + random.uniform(0.5, 2.5);
    if (complaint_of(geometry, lower, upper) != "no error") continue;
    ++accepted;
    const Cylinder c(geometry, lower, upper);
    for (int i = 0; i <= 2500; ++i) {
      const double joint = lower + (upper - lower) * i / 2500;
      ASSERT_NEAR(c.joint_angle(c.at(joint).length).value_or(nan), joint, 1e-9);
      ASSERT_GE(c.at(joint).length, c.shortest() - 1e-12);
      ASSERT_LE(c.at(joint).length, c.longest() + 1e-12);
    }
  }
  EXPECT_GT(accepted, 50);
}

// ---- hostile input ------------------------------------------------------------------------------

TEST(Cylinder, OutOfItsStrokeHasNoJointAngle) {
  for (std::size_t j = 0; j < 3; ++j) {
    const Cylinder& c = cylinder(j);
    for (const double length :
         {c.shortest() - 1e-6, c.longest() + 1e-6, 0.0, -1.0, 1e9, infinity, -infinity, nan}) {
      EXPECT_FALSE(c.joint_angle(length)) << j << " " << length;
    }
    const JointLimits& limits = zx120().limits[j];
    const double at_shortest = j == 0 ? limits.upper : limits.lower;
    EXPECT_NEAR(c.joint_angle(c.shortest() - 5e-13).value(), at_shortest, 1e-12);
    EXPECT_GE(c.joint_angle(c.longest() + 5e-13).value(), limits.lower);
    EXPECT_LE(c.joint_angle(c.longest() + 5e-13).value(), limits.upper);
  }
}

TEST(Cylinder, WhereAFourBarCannotCloseItsStateIsUnknown) {
  const CylinderState open = cylinder(2).at(-70 * degree);
  EXPECT_TRUE(std::isnan(open.length));
  EXPECT_TRUE(std::isnan(open.lever));
  EXPECT_TRUE(std::isnan(cylinder(2).force(-70 * degree, 1e5)));
  EXPECT_TRUE(std::isnan(cylinder(0).at(nan).length));
  EXPECT_TRUE(std::isnan(cylinder(0).at(infinity).length));
  EXPECT_TRUE(std::isnan(cylinder(1).force(1.0, nan)));
}

TEST(Cylinder, SaysWhyItCannotBeMade) {
  const CylinderGeometry plain = {1, {2.0, pi}, PolarPin{0.5, 0.5 * pi}};
  EXPECT_EQ(complaint_of(plain, -1.0, 1.0), "no error");
  EXPECT_EQ(complaint_of(plain, 1.0, -1.0), "has a joint range from 1 to -1 rad, must rise");
  EXPECT_EQ(complaint_of(plain, nan, 1.0), "has a joint range from nan to 1 rad, must rise");
  EXPECT_EQ(complaint_of({0, plain.foot, plain.rod}, -1.0, 1.0), "has count 0, must be >= 1");
  // In line with its foot at pi / 2: the first of 1000 steps beyond is named.
  EXPECT_EQ(complaint_of(plain, -1.0, 2.0).rfind("has a dead point at or near joint angle 1.57", 0),
            0u);
  EXPECT_EQ(complaint_of(plain, -1.0, 0.5 * pi).rfind("has a dead point at or near joint", 0), 0u);
  const CylinderGeometry short_foot = {1, {0.51, pi}, PolarPin{0.5, 0.5 * pi}};
  EXPECT_EQ(complaint_of(short_foot, -1.5, 1.0).rfind("is 0.", 0), 0u);
  EXPECT_NE(complaint_of(short_foot, -1.5, 1.0).find("below twice its shortest"),
            std::string::npos);
  // By the law of cosines 0.52 .. 1.49 m long, and 0.83 .. 1.35 m over less of the range.
  const CylinderGeometry near = {1, {1.0, pi}, PolarPin{0.5, 0.5 * pi}};
  EXPECT_NE(complaint_of(near, -1.4, 1.3).find("below twice its shortest"), std::string::npos);
  EXPECT_EQ(complaint_of(near, -0.6, 0.6), "no error");
  const CylinderGeometry apart = {1, {2.0, pi}, FourBar{{{0.3, pi}, 0.1}, {{0.3, 0.5 * pi}, 0.1}}};
  EXPECT_EQ(complaint_of(apart, -0.5, 0.5),
            "cannot be assembled at joint angle -0.5 rad: its parts do not meet");
  EXPECT_EQ(complaint_of({1, {nan, 0.0}, plain.rod}, -1.0, 1.0),
            "has a foot at distance nan and angle 0, must be finite");
}

TEST(CylindersOfAFile, MayBeLeftOut) {
  const std::string path = testing::TempDir() + "bare" + std::to_string(::getpid()) + ".json";
  json file = json::parse(std::ifstream(zx120_path()));
  file.erase("cylinders");
  std::ofstream(path) << file;
  EXPECT_FALSE(load_machine(path).cylinders);
  std::remove(path.c_str());
}

TEST(CylindersOfAFile, NamesKeyValueAndRuleOfWhatItRefuses) {
  const auto set = [](const char* pointer, const json& value) {
    return complaint_about([&](json& c) { c[json::json_pointer(pointer)] = value; });
  };
  EXPECT_EQ(complaint_about([](json&) {}), "no error");
  EXPECT_EQ(set("/boom/count", 1.5), "cylinders.boom.count: is 1.5, must be 1 or 2");
  EXPECT_EQ(set("/boom/foot/distance_m", 490),
            "cylinders.boom.foot.distance_m: is 490, must be above 0 and at most 100");
  EXPECT_EQ(set("/arm/rod/angle_rad", 155.0).rfind("cylinders.arm.rod.angle_rad: is 155, must", 0),
            0u);
  EXPECT_EQ(set("/bucket/rod", json::object()), "cylinders.bucket.rod: is not a key of this file");
  EXPECT_EQ(set("/bucket/link/length_m", 0),
            "cylinders.bucket.link.length_m: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("/swing", json::object()), "cylinders.swing: is not a key of this file");
  EXPECT_EQ(complaint_about([](json& c) { c["bucket"].erase("link"); }),
            "cylinders.bucket.link: is missing");
  EXPECT_EQ(complaint_about([](json& c) { c.erase("arm"); }), "cylinders.arm: is missing");
}

TEST(CylindersOfAFile, ThatCannotMoveTheirJointAreRefused) {
  const auto set = [](const char* pointer, double value) {
    return complaint_about([&](json& c) { c[json::json_pointer(pointer)] = value; });
  };
  EXPECT_EQ(set("/arm/rod/angle_rad", 1.5)
                .rfind("cylinders.arm: has a dead point at or near joint angle ", 0),
            0u);
  EXPECT_EQ(set("/bucket/link/length_m", 0.20)
                .rfind("cylinders.bucket: cannot be assembled at joint angle ", 0),
            0u);
  EXPECT_EQ(set("/bucket/rocker/angle_rad", 0.0).rfind("cylinders.bucket: ", 0), 0u);
}

// ---- oil ----------------------------------------------------------------------------------------

TEST(Oil, FillsTheSideOfThePistonOrThatOfTheRod) {
  const Piston piston{0.1, 0.06};
  EXPECT_NEAR(piston.area_filled(0.3), 0.0078539816339744830, 1e-17);
  EXPECT_NEAR(piston.area_filled(-0.3), 0.0050265482457436690, 1e-17);
}

// What a relief pressure of 34.5 MPa gives on the assumed pistons, beside the digging forces.
TEST(Oil, PressesOnPistonsThatGiveTheDiggingForces) {
  const Machine& m = zx120();
  ASSERT_TRUE(m.hydraulics);
  EXPECT_NEAR(34.5e6 * m.hydraulics->pistons[1].area_filled(1.0), 355e3, 0.02 * 355e3);
  EXPECT_NEAR(34.5e6 * m.hydraulics->pistons[2].area_filled(1.0), 309e3, 0.04 * 309e3);
}

TEST(Oil, OfAFileMayBeLeftOutButNotInPart) {
  const std::string path = testing::TempDir() + "dry" + std::to_string(::getpid()) + ".json";
  json file = json::parse(std::ifstream(zx120_path()));
  file["cylinders"].erase("hydraulics");
  std::ofstream(path) << file;
  const Machine dry = load_machine(path);
  std::remove(path.c_str());
  EXPECT_TRUE(dry.cylinders);
  EXPECT_FALSE(dry.hydraulics);

  const auto erase = [](const char* object, const char* key) {
    return complaint_about([&](json& c) { c[json::json_pointer(object)].erase(key); });
  };
  EXPECT_EQ(erase("/hydraulics", "pump_flow_m3_per_s"),
            "cylinders.hydraulics.pump_flow_m3_per_s: is missing");
  EXPECT_EQ(erase("/hydraulics", "arm"), "cylinders.hydraulics.arm: is missing");
  EXPECT_EQ(erase("/hydraulics/arm", "rod_diameter_m"),
            "cylinders.hydraulics.arm.rod_diameter_m: is missing");
}

TEST(Oil, OfAFileNamesKeyValueAndRuleOfWhatItRefuses) {
  const auto set = [](const char* key, const json& value) {
    return complaint_about(
        [&](json& c) { c[json::json_pointer(std::string("/hydraulics/") + key)] = value; });
  };
  const std::string where = "cylinders.hydraulics.";
  EXPECT_EQ(set("boom/speed_m_per_s", 0.5), "no error");
  EXPECT_EQ(set("boom/speed_m_per_s", 0),
            where + "boom.speed_m_per_s: is 0, must be above 0 and at most 100");
  EXPECT_EQ(set("pump_flow_m3_per_s", 190),
            where + "pump_flow_m3_per_s: is 190, must be above 0 and at most 1");
  EXPECT_EQ(set("boom/piston_diameter_m", 105),
            where + "boom.piston_diameter_m: is 105, must be above 0 and at most 1");
  EXPECT_EQ(set("boom/rod_diameter_m", 0.105),
            where + "boom.rod_diameter_m: is 0.105, must be below piston_diameter_m = 0.105");
  EXPECT_EQ(set("swing", 1), where + "swing: is not a key of this file");
}

}  // namespace
}  // namespace excavplan
