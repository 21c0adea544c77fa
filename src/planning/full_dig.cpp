// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/full_dig.hpp>

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/dig_ground.hpp>

namespace excavplan {

Found<DigSearchResult> best_full_dig(const Machine& machine, const SoilKind& soil,
                                     double density_percent, const FullDigOptions& options) {
  const FullDigCycle cycle;
  DigSearchOptions search = budget_search();
  search.objective = DigObjective(DigObjective::Goal::cycle);
  search.objective.swing = cycle.swing;
  search.objective.dump_height = cycle.dump_height;
  search.objective.min_fill = options.full;
  search.stop.evaluations = options.evaluations;
  search.threads = options.threads;
  const auto simulator = options.simulator.make(machine, soil, density_percent);
  return search_dig(machine, *simulator, level_planning_ground(machine), search);
}

}  // namespace excavplan
