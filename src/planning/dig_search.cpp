// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>

#include "planning/dig_problem.hpp"

namespace excavplan {

Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options) {
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem problem(machine, soils, terrain, options);
  const SearchResult found = problem.run();
  if (found.feasible()) return problem.best_of(found).result;
  Found<DigSearchResult> none;
  none.nearest = problem.nearest_of(found);
  none.stopped = found.stopped_by == StopReason::cancelled;
  none.evaluations = found.evaluations;
  return none;
}

}  // namespace excavplan
