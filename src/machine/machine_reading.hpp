// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "base/angles.hpp"
#include "base/json.hpp"

/// @file Private to the project.

namespace excavplan {

/// To one side; a swing that goes further has no range; ours [rad].
constexpr double widest_swing_range = 4.0 * pi;

/// The machine of a file whose format was checked. @throws Error (bad_file)
Machine read_machine(JsonObject file);

/// Objects `boom`, `arm`, `bucket`, `swing` of `name`, `sign`, `zero_rad`, each optional, else as
/// in a Machine; names that are not empty differ. @throws Error (bad_file)
RobotJoints read_robot_joints(JsonObject file);
nlohmann::ordered_json robot_joints_json(const RobotJoints& joints);

}  // namespace excavplan
