// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/front_load.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Fall of the bucket's floor towards the tip once it is open, steeper than soil stands; ours.
constexpr double open_floor = 0.25 * pi;

/// Centre of the bucket's cavity in the bucket frame, where the payload is taken to be.
Vector2d cavity_centre(const Bucket& bucket) {
  const std::vector<Vector2d>& corners = bucket.profile;
  Vector2d sum = Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& next = corners[(i + 1) % corners.size()];
    const double twice = cross(corners[i], next);
    sum += twice / 3.0 * (corners[i] + next);
    area += twice;
  }
  return sum / area;
}

/// Of a path from elsewhere a joint may lie beyond its limits: then the lower bound counts.
double within(double value, double lowest, double highest) {
  return std::max(std::min(value, highest), lowest);
}

}  // namespace

FrontLoad::FrontLoad(const Machine& machine, double payload)
    : machine_(machine), payload_(payload), centre_(cavity_centre(machine.bucket)) {}

JointAngles FrontLoad::torque(const JointAngles& joints) const {
  const LinkPositions at = link_positions(machine_, joints);
  return torque_against_link_weight(machine_, at) +
         torque_against_force(machine_, at, bucket_point(at, centre_), {0.0, -payload_ * gravity});
}

double FrontLoad::inertia(const JointAngles& joints) const {
  const LinkPositions at = link_positions(machine_, joints);
  const double pins[] = {machine_.boom_pin.x(), at.arm_pin.x(), at.bucket_pin.x()};
  const double angles[] = {at.phi1, at.phi2, at.phi3};
  double sum = machine_.swing->inertia + payload_ * std::pow(bucket_point(at, centre_).x(), 2);
  for (std::size_t i = 0; i < machine_.links.size(); ++i) {
    const LinkMass& link = machine_.links[i];
    const double x = pins[i] + link.along * std::cos(angles[i]) - link.across * std::sin(angles[i]);
    sum += link.mass * x * x;
  }
  return sum;
}

double pin_height(const Machine& machine, const JointAngles& joints) {
  return link_positions(machine, joints).bucket_pin.y();
}

JointAngles raised(const Machine& machine, const JointAngles& from, double height) {
  const JointLimits& boom = machine.limits[0];
  const JointLimits& arm = machine.limits[1];
  const double rise = height - machine.boom_pin.y();
  JointAngles to = from;
  const Vector2d pin = machine.boom_length * Vector2d(1.0, 0.0) +
                       machine.arm_length * direction(-from[1]);  // with the boom level
  const double sine = within(rise / pin.norm(), -1.0, 1.0);
  to[0] = within(std::atan2(pin.y(), pin.x()) - std::asin(sine), boom.lower, boom.upper);
  if (pin_height(machine, to) < height - 1e-9) {
    const double of_arm = (rise + machine.boom_length * std::sin(to[0])) / machine.arm_length;
    to[1] = within(-to[0] - std::asin(within(of_arm, -1.0, 1.0)), arm.lower, from[1]);
  }
  to[2] = within(from.sum() - to[0] - to[1], machine.limits[2].lower, machine.limits[2].upper);
  return to;
}

JointAngles opened(const Machine& machine, JointAngles joints) {
  const double attitude = open_floor - pi + machine.beta();
  joints[2] = within(-joints[0] - joints[1] - attitude, machine.limits[2].lower, joints[2]);
  return joints;
}

}  // namespace excavplan
