// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/machine.hpp>

namespace excavplan {

/// How a machine stood while it was scanned.
struct MachinePosture {
  double swing = 0.0;  ///< of the boom plane from y = 0 of the site, about z, to the left [rad]
  JointAngles joints = JointAngles::Zero();  ///< boom, arm, bucket [rad]
};

/// The space that boom, arm and bucket take up in the site frame, to leave their points out of a
/// scan (docs/methods.md#machine-in-the-scan). Scan::machine.
class MachineFront {
 public:
  /// @param margin  around the bodies, for what the machine file does not state: plates, hoses,
  /// linkage, errors of the angles [m], >= 0; the default is ours
  /// @throws Error (bad_input) as require_machine(); if an angle or the margin is not finite, or
  /// the margin negative
  MachineFront(const Machine& machine, const MachinePosture& posture, double margin = 0.3);

  /// True of a point [m] in that space.
  bool holds(const Eigen::Vector3d& point) const;

 private:
  using Outline = std::vector<Eigen::Vector2d>;  // corners in the boom plane, (x, z)

  std::vector<Outline> outlines_;
  Eigen::Vector2d ahead_;  // of the boom plane, in x and y
  double half_width_;
  double margin_;
};

}  // namespace excavplan
