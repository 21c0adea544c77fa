// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/experiment/experiment.hpp>

#include "shared/plots.hpp"

/// @file
/// Figures of run-experiment, after the paper's Figs. 7, 8 and 9.

namespace excavplan::tools {

struct NamedExperiment {
  std::string condition;
  ExperimentResult result;
};

struct DrawnExperiments {
  const std::vector<NamedExperiment>& experiments;
  const nlohmann::ordered_json& regression;  ///< by regression_json()
  const SoilKind& soil;
};

/// Paths of the tip along the fixed and the planned path, without the lift; Fig. 9. At most six
/// conditions.
Figure paths_figure(const std::vector<NamedExperiment>& experiments);

/// What the digs along both paths are worth, with the gain; Fig. 8.
Figure efficiency_figure(const std::vector<NamedExperiment>& experiments);

/// Density over bulking factor: digs and regression lines; Fig. 7.
Figure regression_figure(const DrawnExperiments& drawn);

/// paths, efficiency and regression, of an experiment.
FigureTable<DrawnExperiments> experiment_figures(const Arguments::Use& experiment);

}  // namespace excavplan::tools
