// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/survey/efficiency.hpp>

/// @file
/// Efficiencies as JSON, with the keys of docs/formats.md#measure-efficiency, and as lines of text.

namespace excavplan::tools {

nlohmann::ordered_json to_json(const DigEfficiency& run);

/// What counts in one line, then what is known beside it.
std::vector<std::string> run_lines(const DigEfficiency& run);

/// Bounds of a 95 % interval of the gain [%], of the ratio's logarithm; NaN if its sd is.
std::pair<double, double> gain_interval(const Measured& gain_percent);

}  // namespace excavplan::tools
