// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/dig_attempts.hpp"

#include <utility>
#include <variant>

#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "planning/start_rule.hpp"

namespace excavplan {

// NOLINTNEXTLINE(bugprone-easily-swappable-parameters)
DigSearchOptions polish_search(int points, int basins, int polish_evaluations) {
  MemeticSearch method;
  method.first_generation = points;
  method.generations = 0;
  method.basins = basins;
  method.polish_evaluations = polish_evaluations;
  DigSearchOptions options;
  options.method = method;
  return options;
}

DigAttempts::DigAttempts(const Machine& machine, const DigObjective& objective,
                         std::unique_ptr<const SoilSimulator> simulator, Terrain ground,
                         const Progress& progress)
    : machine_(machine),
      objective_(objective),
      simulator_(std::move(simulator)),
      ground_(std::move(ground)),
      progress_(progress) {}

void DigAttempts::search(DigSearchOptions options) {
  if (stopped_) return;
  int evaluations = 0;
  options.threads = 1;
  options.objective = objective_;
  options.progress = [&](const SearchProgress& now) {
    tell(now.evaluations - evaluations, now.best);
    evaluations = now.evaluations;
    return !stopped_;
  };
  const auto found = search_dig(machine_, *simulator_, ground_, options);
  if (found && objective_.rank(found->dig) > rank()) best_ = found->dig;
}

double DigAttempts::measure(const PlannedDig& dig) {
  const DigLayout layout(machine_, ground_);
  auto path = layout.path_from(dig.parameters, dig.start_x);
  if (std::holds_alternative<Infeasible>(path)) {
    path = path_by(layout, dig.parameters, DigSearchOptions{}.start_rule);
  }
  double worth = 0.0;
  if (const auto* drivable = std::get_if<DigPath>(&path)) {
    const auto outcome = dig_of_path(machine_, *simulator_, ground_, *drivable, objective_);
    if (const auto* dug = std::get_if<PlannedDig>(&outcome)) worth = objective_.worth(*dug);
  }
  tell(1, worth);
  return worth;
}

void DigAttempts::tell(int digs, double best) {
  evaluations_ += digs;
  if (progress_ && !progress_(digs, best)) stopped_ = true;
}

}  // namespace excavplan
