// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "figures/experiment_figures.hpp"
#include "frame/tool.hpp"
#include "run_experiment/experiment_inputs.hpp"

/// @file
/// run-experiment by default: section 3 of the paper.

namespace excavplan::tools {

/// What is drawn of an experiment.
struct ExperimentPages {
  const Plots& plots;
  const std::optional<std::string>& report;
};

Outcome simulation_experiment(const Machine& machine, const ExperimentInputs& experiment,
                              const ExperimentPages& pages, Console& console);

}  // namespace excavplan::tools
