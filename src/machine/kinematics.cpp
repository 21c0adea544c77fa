// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double standard_gravity = 9.80665;  // [m/s^2], ISO 80000-3
constexpr double rounding_of_reach = 1e-12;

/// The same direction within half a turn of `center`.
double wrap_near(double angle, double center) {
  const double away = angle - center;
  return std::abs(away) <= pi ? angle : center + std::remainder(away, 2.0 * pi);
}

/// Directions of two links whose sum is a vector, the second turned clockwise from the first.
struct TwoLinks {
  double first = 0.0;  ///< direction of the first [rad]
  double bend = 0.0;   ///< from the first to the second, -pi .. 0 [rad]
};

std::variant<TwoLinks, Unreachable> bridge(const Vector2d& to, double first, double second) {
  const double distance = std::hypot(to.x(), to.y());
  const double cosine =
      (distance * distance - first * first - second * second) / (2.0 * first * second);
  if (std::isnan(cosine)) {
    return Unreachable{Unreachable::Reason::too_far, Joint::boom, infinity, first, infinity};
  }
  if (cosine > 1.0 + rounding_of_reach) {
    const double reach = first + second;
    return Unreachable{Unreachable::Reason::too_far, Joint::boom, distance, reach,
                       distance - reach};
  }
  if (cosine < -1.0 - rounding_of_reach) {
    const double hole = std::abs(first - second);
    return Unreachable{Unreachable::Reason::too_near, Joint::boom, distance, hole, hole - distance};
  }
  TwoLinks links;
  links.bend = -std::acos(std::clamp(cosine, -1.0, 1.0));
  links.first = std::atan2(to.y(), to.x()) -
                std::atan2(second * std::sin(links.bend), first + second * std::cos(links.bend));
  return links;
}

/// The joint angles, set to limits that they exceed by rounding, or the joint furthest outside.
std::variant<JointAngles, Unreachable> within_limits(const Machine& machine, JointAngles joints) {
  Unreachable worst;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    const double angle = wrap_near(joints[i], 0.5 * (limits.lower + limits.upper));
    joints[i] = std::min(std::max(angle, limits.lower), limits.upper);
    const double excess = std::abs(angle - joints[i]);
    if (!(excess <= worst.excess)) {  // NaN is worse than all
      worst = {Unreachable::Reason::joint_limit, static_cast<Joint>(i), angle, joints[i], excess};
    }
  }
  if (!(worst.excess <= rounding_of_reach)) return worst;
  return joints;
}

}  // namespace

LinkPositions link_positions(const Machine& machine, const JointAngles& joints) {
  LinkPositions at;
  at.phi1 = -joints[0];
  at.phi2 = at.phi1 - joints[1];
  at.phi3 = at.phi2 - joints[2];
  at.along = {direction(at.phi1), direction(at.phi2), direction(at.phi3)};
  at.arm_pin = machine.boom_pin + machine.boom_length * at.along[0];
  at.bucket_pin = at.arm_pin + machine.arm_length * at.along[1];
  at.tip = at.bucket_pin + machine.bucket_length * at.along[2];
  return at;
}

BucketPose forward_kinematics(const Machine& machine, const JointAngles& joints) {
  const LinkPositions at = link_positions(machine, joints);
  return {at.tip.x(), at.tip.y(), wrap_near(at.phi3 + pi - machine.beta(), 0.0)};
}

double digging_depth(const Machine& machine) {
  constexpr int steps = 60;  // of each joint; ours
  const auto at = [&](Eigen::Index joint, int step) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(joint)];
    return limits.lower + (limits.upper - limits.lower) * step / steps;
  };
  double lowest = std::numeric_limits<double>::infinity();
  for (int boom = 0; boom <= steps; ++boom) {
    for (int arm = 0; arm <= steps; ++arm) {
      for (int bucket = 0; bucket <= steps; ++bucket) {
        const JointAngles joints(at(0, boom), at(1, arm), at(2, bucket));
        lowest = std::min(lowest, link_positions(machine, joints).tip.y());
      }
    }
  }
  return -lowest;
}

std::variant<JointAngles, Unreachable> inverse_kinematics(const Machine& machine,
                                                          const BucketPose& pose) {
  const double phi3 = pose.floor_angle - pi + machine.beta();
  const Vector2d to_bucket_pin =
      Vector2d(pose.x, pose.z) - machine.bucket_length * direction(phi3) - machine.boom_pin;
  const auto links = bridge(to_bucket_pin, machine.boom_length, machine.arm_length);
  if (const auto* unreachable = std::get_if<Unreachable>(&links)) return *unreachable;
  const auto& [phi1, bend] = std::get<TwoLinks>(links);
  return within_limits(machine, {-phi1, -bend, phi1 + bend - phi3});
}

std::variant<JointAngles, Unreachable> inverse_kinematics_fixed_bucket(const Machine& machine,
                                                                       double x, double z,
                                                                       double bucket) {
  const Vector2d arm_to_tip =
      Vector2d(machine.arm_length, 0.0) + machine.bucket_length * direction(-bucket);
  const auto links =
      bridge(Vector2d(x, z) - machine.boom_pin, machine.boom_length, arm_to_tip.norm());
  if (const auto* unreachable = std::get_if<Unreachable>(&links)) return *unreachable;
  const auto& [phi1, bend] = std::get<TwoLinks>(links);
  const double tip_off_arm = std::atan2(arm_to_tip.y(), arm_to_tip.x());
  return within_limits(machine, {-phi1, tip_off_arm - bend, bucket});
}

LimitMargin limit_margin(const Machine& machine, const JointAngles& joints) {
  LimitMargin smallest{std::numeric_limits<double>::infinity(), Joint::boom};
  for (std::size_t i = 0; i < machine.limits.size(); ++i) {
    const double angle = joints[static_cast<int>(i)];
    const double margin =
        std::min(angle - machine.limits[i].lower, machine.limits[i].upper - angle);
    if (std::isnan(margin)) return {margin, static_cast<Joint>(i)};
    if (margin < smallest.margin) smallest = {margin, static_cast<Joint>(i)};
  }
  return smallest;
}

JointAngles torque_against_force(const Machine& machine, const LinkPositions& at,
                                 const Vector2d& point, const Vector2d& force) {
  return {cross(point - machine.boom_pin, force), cross(point - at.arm_pin, force),
          cross(point - at.bucket_pin, force)};
}

JointAngles torque_against_link_weight(const Machine& machine, const LinkPositions& at,
                                       double swing) {
  const std::array<Vector2d, 3> pins = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  const Vector2d up = machine.up(swing);
  JointAngles torque = JointAngles::Zero();
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const LinkMass& link = machine.links[i];
    const Vector2d& along = at.along[i];
    const Vector2d center =
        pins[i] + link.along * along + link.across * Vector2d(-along.y(), along.x());
    for (std::size_t j = 0; j <= i; ++j) {
      torque[static_cast<int>(j)] -= link.mass * standard_gravity * cross(center - pins[j], up);
    }
  }
  return torque;
}

Vector2d bucket_point(const LinkPositions& at, const Vector2d& along_across) {
  const Vector2d& along = at.along[2];
  return at.bucket_pin + along_across.x() * along +
         along_across.y() * Vector2d(-along.y(), along.x());
}

}  // namespace excavplan
