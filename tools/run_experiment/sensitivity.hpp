// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "run_experiment/experiment_inputs.hpp"

/// @file
/// run-experiment --sensitivity: the best path under each assumption, and what is lost by it.

namespace excavplan::tools {

Outcome sensitivity(const Machine& machine, const ExperimentInputs& inputs, Console& console);

}  // namespace excavplan::tools
