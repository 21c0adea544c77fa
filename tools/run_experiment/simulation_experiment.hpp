// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "frame/tool.hpp"
#include "inputs/plots.hpp"
#include "run_experiment/experiment_inputs.hpp"

/// @file
/// run-experiment by default: section 3 of the paper.

namespace excavplan::tools {

/// What is drawn of an experiment.
struct ExperimentPages {
  const Plots& plots;
  const std::optional<std::string>& report;
};

/// --ground, on which every dig of the experiment begins, and --ground-out.
void declare_experiment_ground(Arguments& arguments, ExperimentInputs& inputs);

Outcome simulation_experiment(const Machine& machine, const ExperimentInputs& experiment,
                              const ExperimentPages& pages, Console& console);

}  // namespace excavplan::tools
