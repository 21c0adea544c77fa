// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/experiments/experiment.hpp>
#include <excavplan/experiments/sensitivity.hpp>
#include <excavplan/soil/density_fit.hpp>

#include "results/json_fwd.hpp"

/// @file
/// What the simulated experiments give: that of the paper's section 3, and best digs under other
/// assumptions.

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

/// The paper's Fig. 7: bulking factors of digs along the fixed path at 0, 5 .. 100 %, the
/// regression of the density on them, and that of the paper.
struct DensityRegression {
  std::vector<DensityCalibration::Sample> samples;
  DensityLine line;                   ///< on the bulking factors as measured
  DensityLine line_without_fallback;  ///< on those by dry mass
  DensityLine paper_line;
};
DensityRegression density_regression(const Machine& machine, const SoilKind& soil,
                                     const ExperimentOptions& options);

Json experiment_json(const NamedExperiment& experiment);
Json regression_json(const DensityRegression& regression);

/// The best dig under an assumption at a density, and what is lost by it.
Json assumption_json(const AssumptionResult& result, const DigObjective& objective);

}  // namespace excavplan
