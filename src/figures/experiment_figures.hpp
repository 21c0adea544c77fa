// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/experiments/experiment.hpp>

#include "inputs/plots.hpp"

/// @file
/// Figures of run-experiment, after the paper's Figs. 7, 8 and 9.

namespace excavplan {

struct NamedExperiment {
  std::string condition;
  ExperimentResult result;
};

/// A condition that could not be dug along one of the paths.
struct FailedExperiment {
  std::string condition;
  double density_percent = 0.0;
  std::size_t place = 0;  ///< conditions before it that were done
};

struct Experiments {
  std::vector<NamedExperiment> done;
  std::vector<FailedExperiment> failed;
  SecondGround second = SecondGround::fresh;
};

struct DrawnExperiments {
  const Experiments& experiments;
  const nlohmann::ordered_json& regression;  ///< by regression_json()
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

/// paths, efficiency and regression, of an experiment.
FigureTable<DrawnExperiments> experiment_figures(const Arguments::Use& experiment);

}  // namespace excavplan
