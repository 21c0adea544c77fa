// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/efficiency/efficiency.hpp>

/// @file
/// What in the log of a dig casts doubt on its consumption. Private to the library.

namespace excavplan {

/// Warnings, all of which end trust: gap_in_log, implausible_fuel and implausible_energy (a mean
/// rate or a reading that no machine has), dig_below_rest, idle_above_dig, idle_in_dig.
/// @param result  with its log, shares and idle rate
std::vector<Warning> doubts_of(const LoggedDig& dig, const DigEfficiency& result);

}  // namespace excavplan
