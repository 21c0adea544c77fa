// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/motion_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planning/front_load.hpp"

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

namespace {

/// All of a motion.
class MotionUse {
 public:
  explicit MotionUse(const MotionCase& made) : made_(made), empty_(made.machine) {}

  UsedLimits between(const Trajectory& motion, Through through) {
    if (made_.height) begin(motion.points.front());
    for (std::size_t k = 1; k < motion.points.size(); ++k) {
      const TrajectoryPoint &from = motion.points[k - 1], &to = motion.points[k];
      const double h = to.time - from.time;
      std::array<Polynomial, 4> joints;
      for (Eigen::Index j = 0; j < 4; ++j) {
        joints[static_cast<std::size_t>(j)] = through(state_of(from, j), state_of(to, j), h);
      }
      const int parts = std::max(10, static_cast<int>(std::ceil(1000.0 * h)));
      for (int part = 0; part <= parts; ++part) see(joints, h * part / parts, from.phase, to.phase);
    }
    const double fraction = made_.options.speed_fraction;
    for (double* share : {&used_.rate, &used_.acceleration, &used_.swing_torque,
                          &used_.cylinder_speed, &used_.flow, &used_.power}) {
      *share /= fraction;
    }
    return used_;
  }

 private:
  void begin(const TrajectoryPoint& point) {
    FrontJoints joints;
    joints << point.joints, point.swing.angle;
    depth_ = std::min(0.0, height_above(made_, joints));
  }

  void see(const std::array<Polynomial, 4>& joints, double t, DigPhase from, DigPhase to) {
    FrontState at;
    for (std::size_t j = 0; j < 4; ++j) {
      const auto joint = static_cast<Eigen::Index>(j);
      at.angles[joint] = joints[j].at(t);
      at.rates[joint] = joints[j].at(t, 1);
      at.accelerations[joint] = joints[j].at(t, 2);
      used_.jerk = std::max(used_.jerk, std::abs(joints[j].at(t, 3)) / made_.options.max_jerk);
    }
    see_joints(at);
    if (from == to || (digs(from) && digs(to))) see_loads(at, to);
    if (made_.height && !digs(from) && !digs(to)) {
      used_.clearance = std::min(used_.clearance, height_above(made_, at.angles) - depth_);
    }
  }

  void see_joints(const FrontState& at) {
    const Machine& machine = made_.machine;
    for (std::size_t j = 0; j < 4; ++j) {
      const auto joint = static_cast<Eigen::Index>(j);
      if (j == 3 && !machine.swing) continue;
      const JointLimits limits =
          j < 3 ? machine.limits[j]
                : JointLimits{machine.swing->lower, machine.swing->upper, machine.swing->speed,
                              machine.swing->acceleration, machine.swing->torque};
      used_.rate = std::max(used_.rate, std::abs(at.rates[joint]) / limits.speed);
      used_.acceleration =
          std::max(used_.acceleration, std::abs(at.accelerations[joint]) / limits.acceleration);
      used_.beyond = std::max(
          {used_.beyond, at.angles[joint] - limits.upper, limits.lower - at.angles[joint]});
    }
  }

  void see_loads(FrontState at, DigPhase phase) {
    const bool full = phase == DigPhase::lift || phase == DigPhase::swing;
    const double payload = full ? made_.payload : 0.0;
    const FrontLoad load(made_.machine, payload);
    at.torque = digs(phase) ? made_.torque : (full ? load : empty_).torque(at.angles.head<3>());
    if (made_.machine.swing) {
      const TurnedInertia turned = inertia_of(made_.machine, at.angles.head<3>(), payload);
      at.swing_torque =
          turned.value * at.accelerations[3] + turned.slope.dot(at.rates.head<3>()) * at.rates[3];
    }
    use_drive(made_, at, used_);
  }

  const MotionCase& made_;
  FrontLoad empty_;
  UsedLimits used_;
  double depth_ = 0.0;  // at which it begins [m], <= 0
};

}  // namespace

UsedLimits used_between(const MotionCase& made, const Trajectory& motion, Through through) {
  return MotionUse(made).between(motion, through);
}

}  // namespace excavplan::test
