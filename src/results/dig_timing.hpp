// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// When the steps of a simulated dig happen, and with what power.

namespace excavplan {

/// One step of a dig, from a pose of its path to the next.
struct TimedStep {
  DigPhase phase = DigPhase::penetrate;
  double time = 0.0;      ///< at its middle, since the dig began [s]
  double duration = 0.0;  ///< [s]
  double power = 0.0;     ///< mean of the joints: the sum of what is positive of torque * rate [W]
};

/// Of each step of the dig's history, by time_dig_path(): the machine's speed along the path.
std::vector<TimedStep> timed_steps(const Machine& machine, const DigPath& path,
                                   const DigResult& dig);

}  // namespace excavplan
