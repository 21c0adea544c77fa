// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/machine/kinematics.hpp>

namespace excavplan {

/// Boom, arm and bucket with what is in it.
class FrontLoad {
 public:
  /// @param payload  in the centre of the bucket's cavity [kg]
  explicit FrontLoad(const Machine& machine, double payload = 0.0);

  /// That holds it, swung to the left by `swing` [N m].
  JointAngles torque(const JointAngles& joints, double swing = 0.0) const;
  /// About the swing axis, with the upper structure: links and payload as points [kg m^2].
  double inertia(const JointAngles& joints) const;

  const Machine& machine() const { return machine_; }

 private:
  const Machine& machine_;
  double payload_;
  Eigen::Vector2d centre_;
};

/// Height of the bucket pin [m].
double pin_height(const Machine& machine, const JointAngles& joints);

/// From a pose the boom, and where that does not suffice the arm, raise the bucket pin; the bucket
/// keeps its attitude as far as its joint can.
JointAngles raised(const Machine& machine, const JointAngles& from, double height);

/// With the bucket so far open that soil slides out.
JointAngles opened(const Machine& machine, JointAngles joints);

}  // namespace excavplan
