// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "study/equal_payload.hpp"

#include <algorithm>

namespace excavplan {

ExperimentOptions at_equal_payload(DigObjective::Goal goal, const ExperimentResult& found,
                                   ExperimentOptions options) {
  constexpr int digs = 120;  // of a search that begins warm; ours
  PlanOptions& plan = options.plan;
  plan.method = PlanMethod::search;
  plan.library.reset();
  plan.search.objective = goal;
  plan.search.objective.min_fill = std::min(1.0, found.fixed.fill);
  plan.search.stop.evaluations = digs;
  plan.search.start = {{found.planned.parameters, found.planned.start_x}};
  options.survey = [estimate = found.estimate](const DigScene&) { return estimate; };
  return options;
}

}  // namespace excavplan
