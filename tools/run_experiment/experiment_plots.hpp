// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "figures/experiment_figures.hpp"
#include "inputs/plots.hpp"

namespace excavplan::tools {

/// paths, efficiency and regression, of an experiment.
FigureTable<DrawnExperiments> experiment_figures(const Arguments::Use& experiment);

}  // namespace excavplan::tools
