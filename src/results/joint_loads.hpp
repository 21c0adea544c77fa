// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/machine/kinematics.hpp>
#include <excavplan/sensing/scene.hpp>

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

/// Boom, arm, bucket.
using JointLoads = std::array<JointLoad, 3>;

JointLoads joint_loads(const Machine& machine, const std::vector<ForceSample>& history);

nlohmann::ordered_json to_json(const Machine& machine, const JointLoads& loads);

/// A line of torques and, where there are cylinders, one of theirs.
std::vector<std::string> load_lines(const Machine& machine, const JointLoads& loads);

/// CSV, a row per step of the dig; columns: docs/formats.md#force-history.
std::string to_csv(const Machine& machine, const DigScene& scene);

}  // namespace excavplan
