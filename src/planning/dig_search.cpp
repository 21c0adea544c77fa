// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>

#include <cmath>
#include <limits>

#include "machine/dig_path_text.hpp"
#include "planning/dig_problem.hpp"

namespace excavplan {
namespace {

/// Of the bucket's length from pin to tip, and angles: ours.
constexpr DigParameters narrowest = {0.1, 0.04, 0.0};
constexpr DigParameters widest = {1.5, 1.2, 3.5};

}  // namespace

DigBounds::DigBounds() {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    lower.*info.field = upper.*info.field = std::numeric_limits<double>::quiet_NaN();
  }
}

DigBounds machine_bounds(const Machine& machine, const DigBounds& bounds) {
  DigBounds filled = bounds;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double unit = info.unit == std::string("m") ? machine.bucket_length : 1.0;
    double& lower = filled.lower.*info.field;
    double& upper = filled.upper.*info.field;
    if (std::isnan(lower)) lower = unit * narrowest.*info.field;
    if (std::isnan(upper)) upper = unit * widest.*info.field;
  }
  return filled;
}

std::string describe(const NearestDig& nearest) {
  return path_text(nearest.parameters, nearest.start_x) + ": " + nearest.reason;
}

DigSearchOptions budget_search() {
  DigSearchOptions options;
  options.objective = dig_goals().front().goal;
  options.start_rule = StartRule::Kind::searched;
  std::get<MemeticSearch>(options.method).generations = 20;  // the budget ends it long before
  return options;
}

int evaluation_budget(bool uncertain, bool from_known) {
  if (!uncertain) return 600;
  return from_known ? 100 : 200;
}

void require_own_checkpoint(const Machine& machine, const SoilSimulator& simulator,
                            const Terrain& terrain, const DigSearchOptions& options) {
  if (!options.resume) return;
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem(machine, soils, terrain, options).require_own_checkpoint();
}

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
