// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/machine/motion.hpp>

/// @file Private to the project.

namespace excavplan {

/// What a machine at rest anywhere on a way could not hold, off the dig, which the simulator looks
/// at: motion_overload, if a joint lacks torque for links and payload; motion_tips, if it tips.
/// Both end trust (docs/methods.md#motion).
std::vector<Warning> load_warnings(const Machine& machine, const Way& way);

}  // namespace excavplan
