// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/machine/motion.hpp>

/// @file Private to the project.

namespace excavplan {

/// What a machine at rest anywhere on a way could not hold, off the dig, which the simulator looks
/// at: motion_overload, if a joint or the swing lacks torque for links and payload; motion_tips, if
/// it tips, on a slope in the dig too. Both end trust (docs/methods.md#motion).
/// @param on_slope  how it stands, for tipping: as stated and as the ground shows
std::vector<Warning> load_warnings(const Machine& machine, const Way& way,
                                   const Attitude& on_slope);
inline std::vector<Warning> load_warnings(const Machine& machine, const Way& way) {
  return load_warnings(machine, way, machine.attitude);
}

}  // namespace excavplan
