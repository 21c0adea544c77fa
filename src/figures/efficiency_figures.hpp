// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/efficiency/efficiency.hpp>

#include "measure_efficiency/efficiency_runs.hpp"
#include "inputs/plots.hpp"

/// @file
/// Figures of measure-efficiency, of one run or two, or of two sets.

namespace excavplan {

struct DrawnRuns {
  const std::vector<DigEfficiency>& runs;
  bool own_meters = false;  ///< as efficiency_gain() takes it
};

/// efficiency and fuel. @param of_logs  possible for logs, not for sets of runs
FigureTable<DrawnRuns> run_figures(const Arguments::Use& of_logs);

/// sets. @param of_sets  possible for sets of runs only
FigureTable<ComparedSets> set_figures(const Arguments::Use& of_sets);

}  // namespace excavplan
