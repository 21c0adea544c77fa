// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/machine_front.hpp>

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "base/non_finite.hpp"
#include "support/errors.hpp"

namespace excavplan {
namespace {

constexpr double half_turn = 3.14159265358979323846;
constexpr double margin = 0.25;

/// Boom pin 1 m up, boom 4 m with its knee 1 m above the middle, arm 2 m, bucket a square of 1 m.
Machine plain_machine() {
  Machine machine = load_machine(find_data_file("machines/zx120.json"));
  machine.boom_pin = {0.0, 1.0};
  machine.boom_length = 4.0;
  machine.arm_length = 2.0;
  machine.bucket_length = 1.0;
  machine.links[0] = {1.0, 2.0, 0.5};
  machine.links[1] = {1.0, 1.0, 0.0};
  machine.bucket.profile = {{1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  machine.bucket.width_outside = 0.8;
  return machine;
}

/// Boom level to (4, 1), arm hanging to (4, -1), bucket curled back: its tip at (3, -1), its square
/// below the line to it.
MachinePosture hanging(double swing) { return {swing, {0.0, 0.5 * half_turn, 0.5 * half_turn}}; }

TEST(MachineFront, HoldsBoomArmAndBucketWithAMargin) {
  const MachineFront front(plain_machine(), hanging(0.0), margin);
  const auto holds = [&](double x, double z) { return front.holds({x, 0.0, z}); };
  EXPECT_TRUE(holds(2.0, 1.0 - 0.99 * margin));  // under the boom
  EXPECT_FALSE(holds(2.0, 1.0 - 1.01 * margin));
  EXPECT_TRUE(holds(2.0, 2.0 + 0.99 * margin));  // over its knee
  EXPECT_FALSE(holds(2.0, 2.0 + 1.01 * margin));
  EXPECT_TRUE(holds(2.0, 1.5));
  EXPECT_FALSE(holds(1.0, 1.5 + margin * std::sqrt(1.25) * 1.01));  // over the slope to the knee
  EXPECT_TRUE(holds(1.0, 1.5 + margin * std::sqrt(1.25) * 0.99));
  EXPECT_TRUE(holds(-0.99 * margin, 1.0));
  EXPECT_FALSE(holds(-1.01 * margin, 1.0));
  EXPECT_TRUE(holds(4.0 + 0.99 * margin, 0.0));  // before the arm
  EXPECT_FALSE(holds(4.0 + 1.01 * margin, 0.0));
  EXPECT_FALSE(holds(4.0 - 1.01 * margin, 0.0));
  EXPECT_TRUE(holds(3.5, -1.5));  // in the bucket
  EXPECT_TRUE(holds(3.5, -2.0 - 0.99 * margin));
  EXPECT_FALSE(holds(3.5, -2.0 - 1.01 * margin));
  EXPECT_TRUE(holds(3.0 - 0.99 * margin, -1.0));  // at the tip
  EXPECT_FALSE(holds(3.0 - 1.01 * margin, -1.0));
}

TEST(MachineFront, IsAsWideAsTheBucketAndTurnsWithTheSwing) {
  const double edge = 0.4 + margin;
  for (const double swing : {0.0, 0.25 * half_turn, -0.5 * half_turn, half_turn}) {
    const MachineFront front(plain_machine(), hanging(swing), margin);
    const Eigen::Vector3d ahead(std::cos(swing), std::sin(swing), 0.0);
    const Eigen::Vector3d left(-std::sin(swing), std::cos(swing), 0.0);
    const Eigen::Vector3d on_boom = 3.0 * ahead + Eigen::Vector3d(0.0, 0.0, 1.0);
    for (const double side : {-1.0, 1.0}) {
      EXPECT_TRUE(front.holds(on_boom + 0.99 * side * edge * left)) << swing;
      EXPECT_FALSE(front.holds(on_boom + 1.01 * side * edge * left)) << swing;
    }
    EXPECT_FALSE(front.holds(-3.0 * ahead + Eigen::Vector3d(0.0, 0.0, 1.0))) << swing;
  }
}

TEST(MachineFront, PointsThatAreNotFiniteAreNotHeld) {
  const MachineFront front(plain_machine(), hanging(0.0));
  EXPECT_FALSE(front.holds({nan, nan, nan}));
  EXPECT_FALSE(front.holds({3.0, 0.0, nan}));
}

TEST(MachineFront, RefusesWhatIsNotFinite) {
  const auto error = [](const MachinePosture& posture, double about) {
    return test::error_of([&] { MachineFront(plain_machine(), posture, about); });
  };
  EXPECT_NE(error({NAN, JointAngles::Zero()}, 0.1).find("swing of the machine"), std::string::npos);
  EXPECT_NE(error({0.0, {0.0, NAN, 0.0}}, 0.1).find("joint angle of the machine"),
            std::string::npos);
  EXPECT_NE(error({}, -0.1).find("margin about the machine"), std::string::npos);
}

// Level ground at z = -2.5, 0.5 m below the bucket, and a machine above it.
TEST(MachineFront, AScanKeepsTheGroundAndLosesTheMachine) {
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 80; ++i) {
    for (int j = 0; j < 40; ++j) cloud->points.emplace_back(0.1 * i, -2.0 + 0.1 * j, -2.5);
  }
  const std::size_t ground = cloud->points.size();
  for (int i = 0; i <= 40; ++i) {
    cloud->points.emplace_back(0.1 * i, 0.3, 1.0);          // boom
    cloud->points.emplace_back(4.0, -0.3, 1.0 - 0.05 * i);  // arm
  }
  Scan scan;
  scan.clouds = {cloud};
  EXPECT_EQ(outline(scan).points, ground + 82);
  scan.machine = std::make_shared<const MachineFront>(plain_machine(), hanging(0.0), margin);
  EXPECT_EQ(outline(scan).points, ground);
  EXPECT_NEAR(outline(scan).height, 0.0, 1e-12);
  scan.machine = std::make_shared<const MachineFront>(plain_machine(), hanging(1.0), margin);
  EXPECT_GT(outline(scan).points, ground + 60);  // swung away from there
}

}  // namespace
}  // namespace excavplan
