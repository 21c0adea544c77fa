// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search.hpp>

#include <utility>

#include "planning/dig_problem.hpp"

namespace excavplan {
namespace {

constexpr int least_to_divide = 60;  // digs of a search in two parts; ours

}  // namespace

Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options) {
  const std::vector<PossibleSoil> soils = {{&simulator, 1.0}};
  DigProblem problem(machine, soils, terrain, options);
  return problem.result_of(problem.run());
}

std::function<bool(const SearchProgress&)> as_part_of(
    const std::function<bool(const SearchProgress&)>& progress, int before, int planned) {
  if (!progress) return nullptr;
  return [=](SearchProgress now) {
    now.evaluations += before;
    now.planned = planned;
    return progress(now);
  };
}

void precede(const Found<DigSearchResult>& earlier, Found<DigSearchResult>& found) {
  if (!found) {
    found.evaluations += digs_of(earlier);
    return;
  }
  found->evaluations += digs_of(earlier);
  if (!earlier) return;
  found->failed += earlier->failed;
  if (!earlier->first_failure.empty()) found->first_failure = earlier->first_failure;
  found->ranks.insert(found->ranks.begin(), earlier->ranks.begin(), earlier->ranks.end());
}

std::optional<Found<DigSearchResult>> search_by_least_work(const Machine& machine,
                                                           const SoilSimulator& simulator,
                                                           const Terrain& terrain,
                                                           DigSearchOptions& options) {
  const StopRules& stop = options.stop;
  const bool by_digs = std::holds_alternative<MemeticSearch>(options.method) &&
                       stop.evaluations >= least_to_divide && stop.stall == 0 &&
                       stop.seconds == 0.0 && !stop.target;
  if (options.start_rule.kind != StartRule::Kind::searched || !by_digs) return std::nullopt;
  const int budget = stop.evaluations;
  DigSearchOptions first = options;
  first.start_rule = StartRule::Kind::least_work;
  first.checkpoint = {};
  first.stop.evaluations = budget / 3;
  first.progress = as_part_of(options.progress, 0, budget);
  auto found = search_dig(machine, simulator, terrain, first);
  options.stop.evaluations = budget - digs_of(found);
  options.progress = as_part_of(options.progress, digs_of(found), budget);
  if (found) options.start.insert(options.start.begin(), found->dig.parameters);
  return found;
}

}  // namespace excavplan
