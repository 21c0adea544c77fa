// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/experiments/experiment.hpp>

#include "figures/experiment_figures.hpp"
#include "report/report.hpp"
#include "frame/tool.hpp"

/// @file
/// What run-experiment writes and prints.

namespace excavplan {

nlohmann::ordered_json experiment_json(const std::string& condition,
                                       const ExperimentResult& result);
std::string experiment_line(const std::string& condition, const ExperimentResult& result);

/// The paper's Fig. 7: bulking factors of digs along the fixed path at 0, 5 .. 100 %, the
/// regression of the density on them, and that of the paper.
nlohmann::ordered_json regression_json(const Machine& machine, const SoilKind& soil,
                                       const ExperimentOptions& options);
std::string regression_line(const nlohmann::ordered_json& regression);

/// Adds the results of a condition to `conditions` of the outcome, and to its lines and warnings.
void add(const NamedExperiment& done, Outcome& outcome);
/// Likewise of one that has none.
void add_failure(const std::string& condition, double density_percent, const std::string& why,
                 Outcome& outcome);

/// The page, without its file: both digs of each condition, dug once more on level ground, and bars
/// of what they are worth.
Report experiment_report(const Machine& machine, const SoilKind& soil, const PlanOptions& options,
                         const Experiments& experiments);

}  // namespace excavplan
