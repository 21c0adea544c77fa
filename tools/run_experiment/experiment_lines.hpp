// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "frame/tool.hpp"
#include "results/experiment_results.hpp"

/// @file
/// What run-experiment prints of the experiment of section 3.

namespace excavplan::tools {

std::string regression_line(const DensityRegression& regression);

/// Adds the results of a condition to `conditions` of the outcome, and to its lines and warnings.
void add(const NamedExperiment& done, Outcome& outcome);
/// Likewise of one that has none.
void add_failure(const FailedExperiment& failed, const std::string& why, Outcome& outcome);

}  // namespace excavplan::tools
