// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drawing/plot.hpp"
#include "results/experiment_results.hpp"

/// @file
/// Figures of an experiment, after the paper's Figs. 7, 8 and 9.

namespace excavplan {

struct DrawnExperiments {
  const Experiments& experiments;
  const DensityRegression& regression;
  const SoilKind& soil;
};

/// Paths of the tip along the fixed and the planned path, without the lift; Fig. 9. At most six
/// conditions, from the first to the last; a note says of how many.
Figure paths_figure(const Experiments& experiments);

/// What the digs along both paths are worth, with the gain; Fig. 8. Conditions that failed are in
/// their places.
Figure efficiency_figure(const Experiments& experiments);

/// Density over bulking factor: digs and regression lines; Fig. 7.
Figure regression_figure(const DrawnExperiments& drawn);

}  // namespace excavplan
