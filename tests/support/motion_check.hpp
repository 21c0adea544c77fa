// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <excavplan/planning/cycle_motion.hpp>

#include "planning/front_load.hpp"

/// @file
/// What a controller makes of the points of a motion.

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

JointState state_of(const TrajectoryPoint& point, Eigen::Index joint);

/// The cubic through two angles and rates.
Polynomial cubic(const JointState& a, const JointState& b, double h);

/// The quintic through two angles, rates and accelerations.
Polynomial quintic(const JointState& a, const JointState& b, double h);

/// Largest shares of the limits that a motion uses between its points, every millisecond or ten
/// times a step, how far a joint is beyond its range [rad], and how near the bucket comes to the
/// ground off the dig, or to the depth in it at which it begins [m].
struct UsedLimits {
  double rate = 0.0, acceleration = 0.0, jerk = 0.0, swing_torque = 0.0;
  double cylinder_speed = 0.0, flow = 0.0, power = 0.0;
  double beyond = -1.0;
  double clearance = std::numeric_limits<double>::infinity();

  double most() const {
    return std::max({rate, acceleration, jerk, swing_torque, cylinder_speed, flow, power});
  }
};

/// A motion and what it was made with.
struct MotionCase {
  Machine machine;
  Way way;
  MotionOptions options;
  JointAngles torque = JointAngles::Zero();  ///< of penetrate, drag, scoop and lift [N m]
  DigPath path;
  double payload = 0.0;  ///< in the bucket after the dig [kg]
  /// Height of the ground before it [m]; nothing: it is not looked at.
  std::function<double(double x, double y)> height = {};
};

/// Of all four joints at one time, and what moves them.
struct FrontState {
  FrontJoints angles, rates, accelerations;
  JointAngles torque = JointAngles::Zero();  ///< of boom, arm, bucket [N m]
  double swing_torque = 0.0;                 ///< [N m]
};

constexpr double at_rest = 1e-9;  ///< a slower joint moves by rounding [rad/s]

bool digs(DigPhase phase);

/// About the swing axis, of points at the centres of the links and of the cavity [kg m^2], and its
/// change per angle of boom, arm and bucket: a second way to it than the library's.
struct TurnedInertia {
  double value = 0.0;
  JointAngles slope = JointAngles::Zero();
};

Eigen::Vector2d centroid(const std::vector<Eigen::Vector2d>& corners);

TurnedInertia inertia_of(const Machine& machine, const JointAngles& joints, double payload);

/// Cylinders, flow and power; the torque of the swing.
void use_drive(const MotionCase& made, const FrontState& at, UsedLimits& used);

/// Height of the bucket's corners above the ground, at both sides and in the middle.
double height_above(const MotionCase& made, const FrontJoints& joints);

/// All of a motion.
class MotionUse {
 public:
  explicit MotionUse(const MotionCase& made) : made_(made), empty_(made.machine) {}

  /// @param through  cubic or quintic
  template <typename Through>
  UsedLimits between(const Trajectory& motion, const Through& through) {
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

/// @param through  cubic or quintic
template <typename Through>
UsedLimits used_between(const MotionCase& made, const Trajectory& motion, const Through& through) {
  return MotionUse(made).between(motion, through);
}

}  // namespace excavplan::test
