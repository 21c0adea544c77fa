// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "experiments/equal_payload.hpp"

#include <algorithm>

namespace excavplan {

ExperimentOptions at_equal_payload(DigObjective::Goal goal, const ExperimentResult& found, int digs,
                                   ExperimentOptions options) {
  PlanOptions& plan = options.plan;
  plan.method = PlanMethod::search;
  plan.library.reset();
  plan.search.objective = goal;
  plan.search.objective.min_fill = std::min(1.0, found.fixed.fill);
  plan.search.stop.evaluations = digs;
  plan.search.start = {{found.planned.parameters, found.planned.start_x}};
  options.estimate = found.estimate;
  return options;
}

}  // namespace excavplan
