// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/efficiency/efficiency.hpp>
#include <excavplan/efficiency/run_comparison.hpp>

#include "frame/tool.hpp"
#include "inputs/logged_dig.hpp"
#include "inputs/scans.hpp"
#include "results/efficiency_results.hpp"

/// @file
/// Runs measured and compared, two or two sets.

namespace excavplan::tools {

/// What measure-efficiency is given.
struct EfficiencyInputs {
  RunInputs first;
  RunInputs second;
  LogInputs logs;
  bool own_meters = false;
  std::optional<std::string> runs, against;
  ScanFrames frames;
  std::optional<double> cell_size;
};

/// One run or two: their efficiencies and the gain of the second. Each has its log, with time and
/// rate for figures.
std::vector<DigEfficiency> compare_two(const EfficiencyInputs& inputs, Outcome& outcome);

/// The set of --runs against that of --against. A recording that counts more than once is warned of
/// (repeated_run), which ends trust.
ComparedSets compare_sets(const EfficiencyInputs& inputs, Outcome& outcome);

}  // namespace excavplan::tools
