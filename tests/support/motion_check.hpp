// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <excavplan/planning/cycle_motion.hpp>

#include "base/random.hpp"

/// @file
/// What a controller makes of the points of a motion, and random motions.

namespace excavplan::test {

/// A polynomial of time and its derivatives.
struct Polynomial {
  std::array<double, 6> factors{};

  double at(double t, int derivative = 0) const {
    double sum = 0.0;
    for (int i = 5; i >= derivative; --i) {
      double factor = factors[static_cast<std::size_t>(i)];
      for (int k = 0; k < derivative; ++k) factor *= i - k;
      sum = sum * t + factor;
    }
    return sum;
  }
};

/// Angle, rate and acceleration.
using JointState = std::array<double, 3>;

inline JointState state_of(const TrajectoryPoint& point, Eigen::Index joint) {
  if (joint == 3) return {point.swing.angle, point.swing.rate, point.swing.acceleration};
  return {point.joints[joint], point.rates[joint], point.accelerations[joint]};
}

/// The cubic through two angles and rates.
inline Polynomial cubic(const JointState& a, const JointState& b, double h) {
  const double rise = b[0] - a[0];
  return {{a[0], a[1], (3.0 * rise - (2.0 * a[1] + b[1]) * h) / (h * h),
           (-2.0 * rise + (a[1] + b[1]) * h) / (h * h * h), 0.0, 0.0}};
}

/// The quintic through two angles, rates and accelerations.
inline Polynomial quintic(const JointState& a, const JointState& b, double h) {
  const double rise = b[0] - a[0] - a[1] * h - 0.5 * a[2] * h * h;
  const double rate = (b[1] - a[1] - a[2] * h) * h, bend = (b[2] - a[2]) * h * h;
  const double h3 = h * h * h;
  return {{a[0], a[1], 0.5 * a[2], (10.0 * rise - 4.0 * rate + 0.5 * bend) / h3,
           (-15.0 * rise + 7.0 * rate - bend) / (h3 * h),
           (6.0 * rise - 3.0 * rate + 0.5 * bend) / (h3 * h * h)}};
}

/// Largest shares of the limits that a motion uses between its points, every millisecond or ten
/// times a step, and how far a joint is beyond its range [rad].
struct UsedLimits {
  double rate = 0.0, acceleration = 0.0, jerk = 0.0;
  double cylinder_speed = 0.0, flow = 0.0, power = 0.0;
  double beyond = -1.0;

  double most() const { return std::max({rate, acceleration, jerk, cylinder_speed, flow, power}); }
};

/// A motion and what it was made with.
struct MotionCase {
  Machine machine;
  Way way;
  MotionOptions options;
  JointAngles torque = JointAngles::Zero();  ///< of penetrate, drag, scoop and lift [N m]
  DigPath path;
};

/// Of all four joints at one time.
struct FrontState {
  FrontJoints angles, rates;
};

constexpr double at_rest = 1e-9;  ///< a slower joint moves by rounding [rad/s]

inline void use_drive(const MotionCase& made, const FrontState& at, bool digs, UsedLimits& used) {
  if (!made.machine.hydraulics) return;
  const Hydraulics& oil = *made.machine.hydraulics;
  double flow = 0.0, pressure = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (std::abs(at.rates[joint]) < at_rest) continue;
    const Cylinder& cylinder = (*made.machine.cylinders)[i];
    const double speed = cylinder.at(at.angles[joint]).lever * at.rates[joint];
    const Piston& piston = oil.pistons[i];
    const double rod = speed < 0.0 ? piston.rod_diameter : 0.0;
    const double area = 0.25 * 3.141592653589793 * (std::pow(piston.diameter, 2) - rod * rod);
    used.cylinder_speed = std::max(used.cylinder_speed, std::abs(speed) / piston.speed);
    flow += cylinder.count() * area * std::abs(speed);
    if (made.torque[joint] * at.rates[joint] <= 0.0) continue;
    const double force = std::abs(cylinder.force(at.angles[joint], made.torque[joint]));
    pressure = std::max(pressure, force / area);
  }
  used.flow = std::max(used.flow, flow / oil.pump_flow);
  if (digs) used.power = std::max(used.power, pressure * flow / made.machine.engine->power);
}

/// @param through  cubic or quintic
template <typename Through>
UsedLimits used_between(const MotionCase& made, const Trajectory& motion, const Through& through) {
  UsedLimits used;
  const Machine& machine = made.machine;
  const auto digs = [](const TrajectoryPoint& point) {
    return point.phase >= DigPhase::penetrate && point.phase <= DigPhase::lift;
  };
  for (std::size_t k = 1; k < motion.points.size(); ++k) {
    const TrajectoryPoint &from = motion.points[k - 1], &to = motion.points[k];
    const double h = to.time - from.time;
    std::array<Polynomial, 4> joints;
    for (Eigen::Index j = 0; j < 4; ++j) {
      joints[static_cast<std::size_t>(j)] = through(state_of(from, j), state_of(to, j), h);
    }
    const int parts = std::max(10, static_cast<int>(std::ceil(1000.0 * h)));
    for (int part = 0; part <= parts; ++part) {
      const double t = h * part / parts;
      FrontState at;
      for (std::size_t j = 0; j < 4; ++j) {
        const auto joint = static_cast<Eigen::Index>(j);
        const bool swing = j == 3;
        at.angles[joint] = joints[j].at(t);
        at.rates[joint] = joints[j].at(t, 1);
        const double bend = std::abs(joints[j].at(t, 2)), jerk = std::abs(joints[j].at(t, 3));
        used.jerk = std::max(used.jerk, jerk / made.options.max_jerk);
        if (swing && made.way.swing_acceleration == 0.0) continue;
        const double speed = swing ? machine.swing->speed : machine.limits[j].speed;
        const double most = swing ? made.way.swing_acceleration : machine.limits[j].acceleration;
        used.rate = std::max(used.rate, std::abs(at.rates[joint]) / speed);
        used.acceleration = std::max(used.acceleration, bend / most);
        if (swing) continue;
        const JointLimits& limits = machine.limits[j];
        used.beyond = std::max(
            {used.beyond, at.angles[joint] - limits.upper, limits.lower - at.angles[joint]});
      }
      use_drive(made, at, digs(from) && digs(to), used);
    }
  }
  const double fraction = made.options.speed_fraction;
  for (double* share :
       {&used.rate, &used.acceleration, &used.cylinder_speed, &used.flow, &used.power}) {
    *share /= fraction;
  }
  return used;
}

/// A dig anywhere on level ground, by a machine with other limits than the one given, from a random
/// posture or none, with or without the rest of the cycle. Nothing if it cannot be driven.
inline std::optional<MotionCase> any_motion(const Machine& machine, const Terrain& ground,
                                            Random& random) {
  MotionCase made{machine, {}, {}, JointAngles::Zero(), {}};
  const auto times = [&](double& number) { number *= std::exp(random.uniform(-0.9, 0.9)); };
  for (JointLimits& limits : made.machine.limits) {
    times(limits.speed);
    times(limits.acceleration);
  }
  times(made.machine.hydraulics->pump_flow);
  times(made.machine.engine->power);
  for (Piston& piston : made.machine.hydraulics->pistons) {
    if (random.uniform() < 0.5) piston.speed = random.uniform(0.1, 0.6);
  }
  const double rates[] = {20.0, 50.0, 100.0, 100.0, 125.0, 250.0};
  made.options.rate = rates[random.index(6)];
  made.options.speed_fraction = random.uniform(0.2, 1.0);
  made.options.corner_tolerance = random.uniform() < 0.2 ? 0.0 : random.uniform(0.0, 0.01);
  if (random.uniform() < 0.3) made.options.max_jerk = std::exp(random.uniform(0.0, 5.0));
  DigParameters dig;
  dig.penetration_angle = random.uniform(0.2, 1.4);
  dig.penetration_length = random.uniform(0.1, 0.9);
  dig.drag_length = random.uniform(0.3, 3.0);
  DigPathOptions rules;
  rules.step = random.uniform(0.01, 0.1);
  const auto level = [](double) { return 0.0; };
  auto path = make_dig_path(made.machine, dig, random.uniform(4.0, 7.5), level, rules);
  if (!std::holds_alternative<DigPath>(path)) return std::nullopt;
  made.path = std::get<DigPath>(std::move(path));
  auto down = way_down(made.machine, made.path, level);
  if (auto* poses = std::get_if<std::vector<DigPose>>(&down)) made.path.approach = *poses;
  DigLoad load;
  for (Eigen::Index i = 0; i < 3; ++i) made.torque[i] = random.uniform(-1e5, 2e5);
  load.torques.assign(made.path.poses.size() - 1, made.torque);
  load.payload_mass = random.uniform(0.0, 800.0);
  CycleWayOptions options;
  options.whole_cycle = random.uniform() < 0.5;
  options.cycle.swing = random.uniform(0.0, 3.1);
  options.cycle.dump_height = random.uniform(0.0, 4.0);
  if (random.uniform() < 0.8) {
    options.start.emplace();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const JointLimits& limits = made.machine.limits[static_cast<std::size_t>(i)];
      (*options.start)[i] = random.uniform(limits.lower, limits.upper);
    }
    (*options.start)[3] = random.uniform() < 0.5 ? 0.0 : random.uniform(-3.1, 3.1);
  }
  auto way = way_of_cycle(made.machine, ground, made.path, load, options);
  if (!std::holds_alternative<Way>(way)) return std::nullopt;
  made.way = std::get<Way>(std::move(way));
  return made;
}

}  // namespace excavplan::test
