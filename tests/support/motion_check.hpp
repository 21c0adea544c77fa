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

/// The polynomial between two points of a joint, `h` apart in time [s]: cubic or quintic.
using Through = Polynomial (*)(const JointState& a, const JointState& b, double h);

/// All of a motion.
UsedLimits used_between(const MotionCase& made, const Trajectory& motion, Through through);

}  // namespace excavplan::test
