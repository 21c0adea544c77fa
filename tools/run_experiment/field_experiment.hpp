// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "run_experiment/experiment_inputs.hpp"

/// @file
/// run-experiment --preset field: section 4 of the paper.

namespace excavplan::tools {

struct FieldInputs {
  std::string preset = "simulation";
  int digs = 10;
  std::string fuel = "zx120";

  bool chosen() const { return preset == "field"; }
};

void declare_field(Arguments& arguments, FieldInputs& inputs);

Outcome field_experiment(const Machine& machine, const FieldInputs& field,
                         const ExperimentInputs& inputs, Console& console);

}  // namespace excavplan::tools
