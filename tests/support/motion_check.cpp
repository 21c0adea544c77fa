// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/motion_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace excavplan::test {

JointState state_of(const TrajectoryPoint& point, Eigen::Index joint) {
  if (joint == 3) return {point.swing.angle, point.swing.rate, point.swing.acceleration};
  return {point.joints[joint], point.rates[joint], point.accelerations[joint]};
}

Polynomial cubic(const JointState& a, const JointState& b, double h) {
  const double rise = b[0] - a[0];
  return {{a[0], a[1], (3.0 * rise - (2.0 * a[1] + b[1]) * h) / (h * h),
           (-2.0 * rise + (a[1] + b[1]) * h) / (h * h * h), 0.0, 0.0}};
}

Polynomial quintic(const JointState& a, const JointState& b, double h) {
  const double rise = b[0] - a[0] - a[1] * h - 0.5 * a[2] * h * h;
  const double rate = (b[1] - a[1] - a[2] * h) * h, bend = (b[2] - a[2]) * h * h;
  const double h3 = h * h * h;
  return {{a[0], a[1], 0.5 * a[2], (10.0 * rise - 4.0 * rate + 0.5 * bend) / h3,
           (-15.0 * rise + 7.0 * rate - bend) / (h3 * h),
           (6.0 * rise - 3.0 * rate + 0.5 * bend) / (h3 * h * h)}};
}

bool digs(DigPhase phase) { return phase >= DigPhase::penetrate && phase <= DigPhase::lift; }

Eigen::Vector2d centroid(const std::vector<Eigen::Vector2d>& corners) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double all = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i) {  // triangles from the first corner
    const Eigen::Vector2d a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    sum += area * (corners[0] + (a + b) / 3.0);
    all += area;
  }
  return sum / all;
}

TurnedInertia inertia_of(const Machine& machine, const JointAngles& joints, double payload) {
  TurnedInertia sum = {machine.swing->inertia, JointAngles::Zero()};
  const double lengths[] = {machine.boom_length, machine.arm_length, 0.0};
  double pin = machine.boom_pin.x(), angle = 0.0;
  JointAngles pin_slope = JointAngles::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    angle += joints[i];  // downwards
    const auto add = [&](double mass, double along, double across) {
      const double x = pin + along * std::cos(angle) + across * std::sin(angle);
      JointAngles slope = pin_slope;
      slope.head(i + 1).array() += across * std::cos(angle) - along * std::sin(angle);
      sum.value += mass * x * x;
      sum.slope += 2.0 * mass * x * slope;
    };
    const LinkMass& link = machine.links[static_cast<std::size_t>(i)];
    add(link.mass, link.along, link.across);
    if (i == 2) {
      const Eigen::Vector2d soil = centroid(machine.bucket.profile);
      add(payload, soil.x(), soil.y());
    }
    pin += lengths[i] * std::cos(angle);
    pin_slope.head(i + 1).array() -= lengths[i] * std::sin(angle);
  }
  return sum;
}

void use_drive(const MotionCase& made, const FrontState& at, UsedLimits& used) {
  const Machine& machine = made.machine;
  double power = std::max(0.0, at.swing_torque * at.rates[3]);
  if (machine.swing) {
    used.swing_torque =
        std::max(used.swing_torque, std::abs(at.swing_torque) / machine.swing->torque);
  }
  double flow = 0.0, pressure = 0.0, work = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (std::abs(at.rates[joint]) < at_rest) continue;
    const double own = at.torque[joint] * at.rates[joint];
    work += std::max(0.0, own);
    if (!machine.hydraulics) continue;
    const Cylinder& cylinder = (*machine.cylinders)[i];
    const double speed = cylinder.at(at.angles[joint]).lever * at.rates[joint];
    const Piston& piston = machine.hydraulics->pistons[i];
    const double rod = speed < 0.0 ? piston.rod_diameter : 0.0;
    const double area = 0.25 * 3.141592653589793 * (std::pow(piston.diameter, 2) - rod * rod);
    used.cylinder_speed = std::max(used.cylinder_speed, std::abs(speed) / piston.speed);
    flow += cylinder.count() * area * std::abs(speed);
    if (own <= 0.0) continue;
    const double force = std::abs(cylinder.force(at.angles[joint], at.torque[joint]));
    pressure = std::max(pressure, force / area);
  }
  if (machine.hydraulics) used.flow = std::max(used.flow, flow / machine.hydraulics->pump_flow);
  power += machine.hydraulics ? pressure * flow : work;
  if (machine.engine) used.power = std::max(used.power, power / machine.engine->power);
}

double height_above(const MotionCase& made, const FrontJoints& joints) {
  const LinkPositions at = link_positions(made.machine, joints.head<3>());
  const double c = std::cos(joints[3]), s = std::sin(joints[3]);
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : made.machine.bucket.profile) {
    const Eigen::Vector2d point = bucket_point(at, corner);
    for (const double share : {-0.5, 0.0, 0.5}) {
      const double y = share * made.machine.bucket.width_outside;
      least =
          std::min(least, point.y() - made.height(point.x() * c - y * s, point.x() * s + y * c));
    }
  }
  return least;
}

}  // namespace excavplan::test
