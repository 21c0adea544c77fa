// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/efficiency/run_comparison.hpp>

/// @file
/// Efficiencies as JSON, with the keys of docs/formats.md#measure-efficiency, and as lines of text.

namespace excavplan {

nlohmann::ordered_json to_json(const DigEfficiency& run);

/// What counts in one line, then what is known beside it.
std::vector<std::string> run_lines(const DigEfficiency& run);

/// Both sets, the gain, its interval and the tests.
nlohmann::ordered_json to_json(const SetComparison& sets);
/// The same for people. @param symbol  of the efficiency
std::vector<std::string> set_lines(const SetComparison& sets, const std::string& symbol);

/// Bounds of a 95 % interval of the gain [%], of the ratio's logarithm; NaN if its sd is.
std::pair<double, double> gain_interval(const Measured& gain_percent);

}  // namespace excavplan
