// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/efficiency/run_comparison.hpp>

#include "results/json_fwd.hpp"

/// @file
/// Efficiencies with the keys of docs/formats.md#measure-efficiency.

namespace excavplan {

/// Two sets of runs and what comes of them.
struct ComparedSets {
  std::vector<DigEfficiency> against;
  std::vector<DigEfficiency> runs;
  SetComparison comparison;
};

Json run_json(const DigEfficiency& run);

/// Both sets, the gain, its interval and the tests.
Json comparison_json(const SetComparison& sets);
/// The gain with its interval and its test, in one line.
std::string gain_text(const SetComparison& sets);

/// Bounds of a 95 % interval of the gain [%], of the ratio's logarithm; NaN if its sd is.
std::pair<double, double> gain_interval(const Measured& gain_percent);

}  // namespace excavplan
