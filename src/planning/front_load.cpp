// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/front_load.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "machine/machine_mass.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Fall of the bucket's floor towards the tip once it is open, steeper than soil stands; ours.
constexpr double open_floor = 0.25 * pi;

/// Of a path from elsewhere a joint may lie beyond its limits: then the lower bound counts.
double within(double value, double lowest, double highest) {
  return std::max(std::min(value, highest), lowest);
}

}  // namespace

FrontLoad::FrontLoad(const Machine& machine, double payload)
    : machine_(machine), payload_(payload), centre_(cavity_centre(machine.bucket)) {}

JointAngles FrontLoad::torque(const JointAngles& joints, double swing) const {
  const LinkPositions at = link_positions(machine_, joints);
  return torque_against_link_weight(machine_, at, swing) +
         torque_against_force(machine_, at, bucket_point(at, centre_),
                              -payload_ * gravity * machine_.up(swing));
}

double FrontLoad::inertia(const JointAngles& joints) const {
  return swing_inertia(machine_, centre_, joints, payload_);
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
