// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/machine/trajectory.hpp>

#include <algorithm>

#include <nlohmann/json.hpp>

#include <excavplan/base/error.hpp>

#include "support/cases.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

JointAngles any_joints(Random& random) {
  JointAngles joints;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const JointLimits& limits = zx120().limits[static_cast<std::size_t>(i)];
    joints(i) = random.uniform(limits.lower, limits.upper);
  }
  return joints;
}

TEST(MachineProperties, KinematicsAreInverse) {
  for_cases([](Random& random) {
    const JointAngles joints = any_joints(random);
    const BucketPose pose = forward_kinematics(zx120(), joints);
    const auto found = inverse_kinematics(zx120(), pose);
    const auto* back = std::get_if<JointAngles>(&found);
    ASSERT_NE(back, nullptr);
    EXPECT_LT((*back - joints).cwiseAbs().maxCoeff(), 1e-7) << joints.transpose();
    const auto fixed = inverse_kinematics_fixed_bucket(zx120(), pose.x, pose.z, joints(2));
    if (const auto* same = std::get_if<JointAngles>(&fixed)) {
      const BucketPose again = forward_kinematics(zx120(), *same);
      EXPECT_NEAR(again.x, pose.x, 1e-9);
      EXPECT_NEAR(again.z, pose.z, 1e-9);
      EXPECT_EQ((*same)(2), joints(2));
    }
  });
}

TEST(MachineProperties, WhatCannotBeReachedIsSaidToBeSo) {
  for_cases([](Random& random) {
    const BucketPose pose{random.uniform(-12.0, 12.0), random.uniform(-12.0, 12.0),
                          random.uniform(-3.0, 3.0)};
    const auto found = inverse_kinematics(zx120(), pose);
    if (const auto* joints = std::get_if<JointAngles>(&found)) {
      const BucketPose back = forward_kinematics(zx120(), *joints);
      EXPECT_LT(std::hypot(back.x - pose.x, back.z - pose.z), 1e-9);
      EXPECT_GE(limit_margin(zx120(), *joints).margin, 0.0);
      return;
    }
    const auto& failure = std::get<Unreachable>(found);
    EXPECT_GT(failure.excess, 0.0);
    EXPECT_NEAR(failure.excess, std::abs(failure.value - failure.limit), 1e-12);
    const double shortest = std::abs(zx120().boom_length - zx120().arm_length);
    if (failure.reason == Unreachable::Reason::too_near) {
      EXPECT_NEAR(failure.limit, shortest, 1e-12);
    }
  });
}

/// Virtual work: the torque that holds a force turns as much work as the force does.
TEST(MachineProperties, TorqueDoesTheWorkOfTheForce) {
  for_cases([](Random& random) {
    const JointAngles joints = any_joints(random);
    const JointAngles rates = drawn_vector(random, 3, -1.0, 1.0);
    const Eigen::Vector2d force = drawn_vector(random, 2, -1e4, 1e4);
    const Eigen::Vector2d place = drawn_vector(random, 2, -1.0, 1.0);
    constexpr double h = 1e-5;
    const auto point = [&](double time) {
      return bucket_point(link_positions(zx120(), joints + time * rates), place);
    };
    const LinkPositions at = link_positions(zx120(), joints);
    const double turned = torque_against_force(zx120(), at, point(0.0), force).dot(rates);
    const double done = -force.dot(point(h) - point(-h)) / (2.0 * h);
    EXPECT_NEAR(turned, done, 1e-4 * 1e4);
  });
}

/// And the torque against the weight of the links lifts their masses.
TEST(MachineProperties, TorqueAgainstTheLinksIsTheGradientOfTheirPotential) {
  for_cases([](Random& random) {
    const JointAngles joints = any_joints(random);
    const JointAngles rates = drawn_vector(random, 3, -1.0, 1.0);
    const auto potential = [&](double time) {
      const LinkPositions at = link_positions(zx120(), joints + time * rates);
      const double pins[] = {zx120().boom_pin.y(), at.arm_pin.y(), at.bucket_pin.y()};
      const double angles[] = {at.phi1, at.phi2, at.phi3};
      double sum = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const LinkMass& link = zx120().links[i];
        const double height =
            pins[i] + link.along * std::sin(angles[i]) + link.across * std::cos(angles[i]);
        sum += link.mass * 9.80665 * height;
      }
      return sum;
    };
    constexpr double h = 1e-5;
    const JointAngles torque = torque_against_link_weight(zx120(), link_positions(zx120(), joints));
    EXPECT_NEAR(torque.dot(rates), (potential(h) - potential(-h)) / (2.0 * h), 1.0);
  });
}

TEST(MachineProperties, CylindersAreInverseAndTheirLeversTheirSlopes) {
  for_cases([](Random& random) {
    const JointAngles joints = any_joints(random);
    const JointAngles torque = drawn_vector(random, 3, -1e5, 1e5);
    const auto states = cylinder_states(*zx120().cylinders, joints);
    const Eigen::Vector3d forces = cylinder_forces(*zx120().cylinders, joints, torque);
    for (std::size_t i = 0; i < 3; ++i) {
      const Cylinder& cylinder = (*zx120().cylinders)[i];
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_TRUE(cylinder.shortest() - 1e-12 <= states[i].length &&
                  states[i].length <= cylinder.longest() + 1e-12);
      EXPECT_LT(cylinder.longest(), 2.0 * cylinder.shortest());
      const auto back = cylinder.joint_angle(states[i].length);
      ASSERT_TRUE(back);
      EXPECT_NEAR(*back, joints(row), 1e-6);
      constexpr double h = 1e-6;
      const double slope =
          (cylinder.at(joints(row) + h).length - cylinder.at(joints(row) - h).length) / (2.0 * h);
      EXPECT_NEAR(states[i].lever, slope, 1e-6);
      // power of the cylinders = power of the joint, at any rate
      EXPECT_NEAR(cylinder.count() * forces(row) * states[i].lever, torque(row), 1e-6 * 1e5);
    }
  });
}

/// Of a mining shovel: a lip of 0.3 m is one, of 1.1 m none.
TEST(MachineProperties, LipsMayBeThick) {
  const TemporaryFolder folder;
  nlohmann::json file = nlohmann::json::parse(content_of(find_data_file("machines/zx120.json")));
  for (const double thickness : {0.05, 0.3, 1.0, 1.1}) {
    file["bucket"]["edge_thickness_m"] = thickness;
    const std::string path = folder.write("machine" + std::to_string(thickness), file.dump());
    if (thickness > 1.0) {
      EXPECT_THROW(load_machine(path), Error);
    } else {
      EXPECT_EQ(load_machine(path).bucket.edge_thickness, thickness);
    }
  }
}

/// The same cylinder with the zero of its joint anywhere, the pin on the link turned with it, and
/// with both pins turned.
TEST(MachineProperties, CylindersDoNotDependOnTheZeroOfTheirJoint) {
  for_cases(
      [](Random& random) {
        const double zero = random.uniform(-7.0, 7.0);
        const double both = random.uniform(-7.0, 7.0);
        const auto cylinder = [&](double turned) {
          const double straight = 3.141592653589793 + both;
          const CylinderGeometry geometry = {
              1, {1.0, straight}, PolarPin{0.5, straight - 0.5 * 3.141592653589793 + turned}};
          return Cylinder(geometry, turned - 0.6, turned + 0.6);
        };
        const Cylinder plain = cylinder(0.0);
        const Cylinder turned = cylinder(zero);
        const double joint = random.uniform(-0.59, 0.59);
        EXPECT_NEAR(turned.at(joint + zero).length, plain.at(joint).length, 1e-12);
        const auto back = turned.joint_angle(plain.at(joint).length);
        ASSERT_TRUE(back);
        EXPECT_NEAR(*back, joint + zero, 1e-9);
      },
      500);
}

struct Dig {
  DigParameters parameters;
  double start_x = 0.0;
  double slope = 0.0;
};

Dig any_dig(Random& random) {
  Dig dig;
  dig.parameters.penetration_angle = random.uniform(0.2, 1.4);
  dig.parameters.penetration_length = random.uniform(0.1, 0.9);
  dig.parameters.drag_length = random.uniform(0.3, 3.0);
  dig.start_x = random.uniform(4.0, 7.5);
  dig.slope = random.uniform(-0.2, 0.2);
  return dig;
}

DigPathOptions coarse(double deepest) {
  DigPathOptions options;
  options.step = 0.1;
  options.max_depth = deepest;
  return options;
}

std::optional<DigPath> path_of(const Dig& dig, double deepest) {
  const auto ground = [&](double x) { return dig.slope * (x - 5.0); };
  auto path = make_dig_path(zx120(), dig.parameters, dig.start_x, ground, coarse(deepest));
  if (auto* laid = std::get_if<DigPath>(&path)) return std::move(*laid);
  return std::nullopt;
}

/// The tip in its plane: in along the line of penetration, level along the drag, turned in the
/// scoop; never deeper than allowed, never outside the joint limits.
TEST(MachineProperties, PathsStayInTheirLimits) {
  int laid = 0;
  for_cases([&](Random& random) {
    const Dig dig = any_dig(random);
    const double deepest = random.uniform(0.1, 0.9);
    const auto path = path_of(dig, deepest);
    if (!path) return;
    ++laid;
    const double angle = dig.parameters.penetration_angle;
    const double length = dig.parameters.penetration_length;
    const double bottom = path->ground_z - length * std::sin(angle);
    double margin = 1e9;
    for (const DigPose& pose : path->poses) {
      margin = std::min(margin, limit_margin(zx120(), pose.joints).margin);
      EXPECT_LE(path->ground_z - pose.bucket.z, deepest + 1e-9);
      const BucketPose back = forward_kinematics(zx120(), pose.joints);
      EXPECT_LT(std::hypot(back.x - pose.bucket.x, back.z - pose.bucket.z), 1e-9);
      if (pose.phase == DigPhase::penetrate) {
        const double in = dig.start_x - pose.bucket.x;
        EXPECT_NEAR(path->ground_z - pose.bucket.z, in * std::tan(angle), 1e-9);
      }
      if (pose.phase == DigPhase::drag) {
        EXPECT_NEAR(pose.bucket.z, bottom, 1e-9);
      }
    }
    EXPECT_GE(margin, 0.0);
    EXPECT_NEAR(margin, path->limit_margin.margin, 1e-12);
  });
  EXPECT_GT(laid, many / 10);  // else nothing was tried
}

/// The stated rates keep the limits, and so do differences between the points.
TEST(MachineProperties, TrajectoriesKeepTheRatesOfTheMachine) {
  int timed = 0;
  for_cases([&](Random& random) {
    const Dig dig = any_dig(random);
    TrajectoryOptions options;
    options.speed_fraction = random.uniform(0.1, 1.0);
    options.corner_tolerance = random.uniform() < 0.3 ? 0.0 : random.uniform(0.0, 0.01);
    const auto path = path_of(dig, 2.0);
    if (!path) return;
    ++timed;
    const Trajectory trajectory = time_dig_path(zx120(), *path, options);
    for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
      const TrajectoryPoint& point = trajectory.points[i];
      for (Eigen::Index j = 0; j < 3; ++j) {
        const JointLimits& limits = zx120().limits[static_cast<std::size_t>(j)];
        const double speed = options.speed_fraction * limits.speed * (1.0 + 1e-6);
        EXPECT_LE(std::abs(point.rates(j)), speed);
        if (i == 0) continue;
        const TrajectoryPoint& before = trajectory.points[i - 1];
        EXPECT_GT(point.time, before.time);
        const double step = point.time - before.time;
        EXPECT_LE(std::abs(point.joints(j) - before.joints(j)) / step, speed);
        EXPECT_LE(std::abs(point.rates(j) - before.rates(j)) / step,
                  options.speed_fraction * limits.acceleration * (1.0 + 1e-6));
      }
    }
    EXPECT_EQ(trajectory.points.front().rates, JointAngles(JointAngles::Zero()));
    EXPECT_EQ(trajectory.points.back().rates, JointAngles(JointAngles::Zero()));
  });
  EXPECT_GT(timed, many / 10);
}

TEST(MachineProperties, SlowerMachinesTakeLonger) {
  for_cases(
      [](Random& random) {
        const auto path = path_of(any_dig(random), 2.0);
        if (!path) return;
        TrajectoryOptions options;
        options.speed_fraction = random.uniform(0.2, 0.9);
        const double quick = time_dig_path(zx120(), *path, options).duration();
        options.speed_fraction *= 0.5;
        EXPECT_GT(time_dig_path(zx120(), *path, options).duration(), 1.3 * quick);
      },
      1000);
}

}  // namespace
}  // namespace excavplan::test
