// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/efficiency/run_comparison.hpp>

/// @file
/// Efficiencies for people.

namespace excavplan::tools {

/// What counts in one line, then what is known beside it.
std::vector<std::string> run_lines(const DigEfficiency& run);

/// Both sets, the gain and its test. @param symbol  of the efficiency
std::vector<std::string> set_lines(const SetComparison& sets, const std::string& symbol);

}  // namespace excavplan::tools
