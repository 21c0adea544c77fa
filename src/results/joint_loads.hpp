// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/machine/kinematics.hpp>
#include <excavplan/sensing/scene.hpp>

#include "results/json_fwd.hpp"

/// @file
/// Loads of the joints and of their cylinders in a dig, from its force history.

namespace excavplan {

/// Of each cylinder of a joint.
struct CylinderUse {
  double peak_force = 0.0;  ///< the largest push (positive) or pull (negative) [N]
  double shortest = 0.0;    ///< [m]
  double longest = 0.0;     ///< [m]
};

struct JointLoad {
  double peak_torque = 0.0;             ///< the largest either way, with its sign [N m]
  std::optional<CylinderUse> cylinder;  ///< empty if the machine's file has none
};

inline constexpr std::array<Joint, 3> joint_order = {Joint::boom, Joint::arm, Joint::bucket};

/// In that order.
using JointLoads = std::array<JointLoad, 3>;

JointLoads joint_loads(const Machine& machine, const std::vector<ForceSample>& history);

Json joint_loads_json(const Machine& machine, const JointLoads& loads);

/// What a cylinder moved as a share of its stroke.
double stroke_share(const Cylinder& cylinder, const CylinderUse& use);

}  // namespace excavplan
