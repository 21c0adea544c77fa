// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "figures/efficiency_figures.hpp"
#include "inputs/plots.hpp"

namespace excavplan::tools {

/// efficiency and fuel. @param of_logs  possible for logs, not for sets of runs
FigureTable<DrawnRuns> run_figures(const Arguments::Use& of_logs);

/// sets. @param of_sets  possible for sets of runs only
FigureTable<ComparedSets> set_figures(const Arguments::Use& of_sets);

}  // namespace excavplan::tools
