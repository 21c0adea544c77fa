// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <variant>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>

/// @file
/// Postures of a machine: where its pins and its tip are, which joint angles reach a pose, and what
/// torque the joints need. Frame and angles as in machine.hpp.

namespace excavplan {

/// Position of the tip and attitude of the bucket.
struct BucketPose {
  double x = 0.0;            ///< of the tip [m]
  double z = 0.0;            ///< of the tip [m]
  double floor_angle = 0.0;  ///< [rad]
};

/// Pins and tip in one posture, (x, z) [m].
struct LinkPositions {
  Eigen::Vector2d arm_pin;     ///< between boom and arm
  Eigen::Vector2d bucket_pin;  ///< between arm and bucket
  Eigen::Vector2d tip;         ///< of the teeth
  double phi1 = 0.0;           ///< direction of the boom [rad]
  double phi2 = 0.0;           ///< of the arm [rad]
  double phi3 = 0.0;           ///< of the bucket [rad]
  /// Unit vectors of these directions.
  std::array<Eigen::Vector2d, 3> along = {Eigen::Vector2d::UnitX(), Eigen::Vector2d::UnitX(),
                                          Eigen::Vector2d::UnitX()};
};

/// Pins and tip for these joint angles.
LinkPositions link_positions(const Machine& machine, const JointAngles& joints);

/// Tip and floor angle for these joint angles.
BucketPose forward_kinematics(const Machine& machine, const JointAngles& joints);

/// How deep below z = 0 the tip comes within the limits of the joints [m].
double digging_depth(const Machine& machine);

/// Why a pose cannot be reached.
struct Unreachable {
  /// Distance of the bucket pin from the boom pin, or a joint angle.
  enum class Reason { too_far, too_near, joint_limit };
  Reason reason = Reason::too_far;  ///< the first that applies
  Joint joint = Joint::boom;        ///< for joint_limit: the one furthest outside
  /// What the pose needs: a joint angle [rad], or the distance from the boom pin to the bucket pin
  /// [m] (to the tip where the bucket angle is given).
  double value = 0.0;
  double limit = 0.0;   ///< what the machine allows of it
  double excess = 0.0;  ///< |value - limit|, > 0
};

/// Joint angles of a pose, in closed form, with the elbow above the line from boom pin to bucket
/// pin. They are within the limits of the joints; an angle outside by rounding, 1e-12 rad, is set
/// to the limit. NaN in the pose gives too_far.
std::variant<JointAngles, Unreachable> inverse_kinematics(const Machine& machine,
                                                          const BucketPose& pose);

/// The same with the joint angle `bucket` given instead of the floor angle: the posture with the
/// tip at (x, z) and the elbow above the line from boom pin to tip.
std::variant<JointAngles, Unreachable> inverse_kinematics_fixed_bucket(const Machine& machine,
                                                                       double x, double z,
                                                                       double bucket);

/// The smallest distance of a posture to a joint limit.
struct LimitMargin {
  double margin = 0.0;        ///< [rad], negative outside
  Joint joint = Joint::boom;  ///< that is nearest to its limit
};

/// Distance of these joint angles to the limits.
LimitMargin limit_margin(const Machine& machine, const JointAngles& joints);

/// Torque of the joints [N m] that balances a force (x, z) [N] on the bucket at `point` [m]: minus
/// the transposed Jacobian times the force.
JointAngles torque_against_force(const Machine& machine, const LinkPositions& at,
                                 const Eigen::Vector2d& point, const Eigen::Vector2d& force);

/// Torque of the joints [N m] that balances the weight of boom, arm and bucket, with the machine as
/// it stands (Machine::attitude) and swung to the left [rad].
JointAngles torque_against_link_weight(const Machine& machine, const LinkPositions& at,
                                       double swing = 0.0);

/// A point of the bucket frame (along, across) in the boom plane.
Eigen::Vector2d bucket_point(const LinkPositions& at, const Eigen::Vector2d& along_across);

}  // namespace excavplan
