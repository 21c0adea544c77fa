// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>

/// @file
/// Postures of a machine: where its pins and its tip are, which joint angles reach a pose, and what
/// torque the joints need. Frame and angles as in machine.hpp.

namespace excavplan {

/// Where the tip is and how the bucket stands.
struct BucketPose {
  double x = 0.0;            ///< of the tip [m]
  double z = 0.0;            ///< of the tip [m]
  double floor_angle = 0.0;  ///< [rad]
};

/// Pins and tip for one posture [m].
struct LinkPositions {
  Eigen::Vector2d arm_pin;
  Eigen::Vector2d bucket_pin;
  Eigen::Vector2d tip;
  double phi1 = 0.0, phi2 = 0.0, phi3 = 0.0;  ///< directions of the links [rad]
};

LinkPositions link_positions(const Machine& machine, const JointAngles& joints);
BucketPose forward_kinematics(const Machine& machine, const JointAngles& joints);

/// Why a pose cannot be held.
struct Unreachable {
  enum class Reason { too_far, too_near, joint_limit };
  Reason reason = Reason::too_far;
  Joint joint = Joint::boom;  ///< for joint_limit: the one furthest outside
  /// What the pose asks for: the joint angle [rad], or the distance from the boom pin to the bucket
  /// pin [m] (to the tip where the bucket angle is held).
  double value = 0.0;
  double limit = 0.0;   ///< what the machine allows of it
  double excess = 0.0;  ///< |value - limit|, > 0
};

/// Closed form for the planar chain, elbow above the line from boom pin to bucket pin, exact to
/// rounding; NaN in the pose gives too_far. Limits are checked, and the answer is within them
/// (what is outside by rounding, 1e-12 rad, is put onto the limit).
std::variant<JointAngles, Unreachable> inverse_kinematics(const Machine& machine,
                                                          const BucketPose& pose);

/// The same with the bucket angle held instead of the floor angle: the posture that puts the tip at
/// (x, z) with joint angle `bucket`, elbow above the line from boom pin to tip.
std::variant<JointAngles, Unreachable> inverse_kinematics_fixed_bucket(const Machine& machine,
                                                                       double x, double z,
                                                                       double bucket);

/// By how much the posture keeps within the limits: the smallest distance to a limit [rad],
/// negative outside, and its joint.
struct LimitMargin {
  double margin = 0.0;
  Joint joint = Joint::boom;
};
LimitMargin limit_margin(const Machine& machine, const JointAngles& joints);

/// Torque the joints must give to hold a force (x, z) [N] that acts on the bucket at `point` [m]:
/// minus the transposed Jacobian times the force.
JointAngles torque_against_force(const Machine& machine, const LinkPositions& at,
                                 const Eigen::Vector2d& point, const Eigen::Vector2d& force);

/// Torque the joints must give to hold the weight of boom, arm and bucket.
JointAngles torque_against_link_weight(const Machine& machine, const LinkPositions& at);

/// A point of the bucket frame (along, across) in the boom plane.
Eigen::Vector2d bucket_point(const LinkPositions& at, const Eigen::Vector2d& along_across);

}  // namespace excavplan
