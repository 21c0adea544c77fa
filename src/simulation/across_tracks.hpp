// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

/// @file Private to the project.

namespace excavplan {

/// Half of the gauge over the x of the front edge: half of the tumbler distance; ours, from 0.69 of
/// the ZX120's data sheet and alike of others.
inline constexpr double side_edge = 0.69;

/// Whether a front looks across the tracks rather than along them. @param swung  from them [rad]
bool is_across(double swung);

/// The machine as it looks along or across its tracks, whichever is nearer: undercarriage,
/// attitude, the edges over which it tips and the limits of its swing are those from ahead of the
/// front then.
/// @param swung  of the front from the tracks [rad]
Machine looking(Machine machine, double swung);

}  // namespace excavplan
