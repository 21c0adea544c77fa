// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/dig_attempts.hpp"

#include <utility>
#include <variant>

namespace excavplan {

DigAttempts::DigAttempts(const Machine& machine, std::unique_ptr<const SoilSimulator> simulator,
                         Terrain ground, const Progress& progress)
    : machine_(machine),
      simulator_(std::move(simulator)),
      ground_(std::move(ground)),
      progress_(progress) {}

void DigAttempts::search(DigSearchOptions options) {
  if (stopped_) return;
  int evaluations = 0;
  options.threads = 1;
  options.progress = [&](const SearchProgress& now) {
    tell(now.evaluations - evaluations, now.best);
    evaluations = now.evaluations;
    return !stopped_;
  };
  const auto found = search_dig(machine_, *simulator_, ground_, options);
  if (found && found->dig.efficiency() > efficiency()) best_ = found->dig;
}

double DigAttempts::measure(const PlannedDig& dig) {
  auto outcome = evaluate_dig(machine_, *simulator_, ground_, dig.parameters, dig.start_x);
  if (const auto* failure = std::get_if<DigFailure>(&outcome);
      failure != nullptr && std::holds_alternative<Infeasible>(*failure)) {
    outcome =
        evaluate_dig(machine_, *simulator_, ground_, dig.parameters, DigSearchOptions{}.start_rule);
  }
  const auto* dug = std::get_if<PlannedDig>(&outcome);
  const double efficiency = dug ? dug->efficiency() : 0.0;
  tell(1, efficiency);
  return efficiency;
}

void DigAttempts::tell(int digs, double best) {
  evaluations_ += digs;
  if (progress_ && !progress_(digs, best)) stopped_ = true;
}

}  // namespace excavplan
