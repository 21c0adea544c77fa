// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/planning/uncertain_soil.hpp>

/// @file
/// A dig in lines of text.

namespace excavplan {

/// "45.0 deg, 0.350 m, 1.50 m from x = 6.05 m"
std::string path_text(const PlannedDig& dig);

/// The worth of a dig in the unit of its goal: "25.1 kg/kJ".
std::string worth_text(const DigObjective& objective, double worth);

/// Path, payload, energy, efficiency and duration.
std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread = {});

}  // namespace excavplan
