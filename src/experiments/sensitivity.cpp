// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/experiments/sensitivity.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>
#include <variant>

#include <excavplan/base/error.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/parallel.hpp"
#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

/// Soil of one density in the reference.
class Reference {
 public:
  Reference(const DigModel& model, double density)
      : model_(model),
        ground_(level_planning_ground(model.machine, model.cell_size)),
        layout_(model.machine, ground_, model.search.rules),
        simulator_(make_simulator(model.simulator, model.machine, model.soil, density)) {}

  /// From its own start, or if it cannot be dug from there, from the nearest where it can.
  std::variant<PlannedDig, DigFailure> dig(const PlannedDig& best) const {
    constexpr double step = 0.05, farthest = 2.0;  // between starts, from its own [m]; ours
    auto outcome = dig_from(best.parameters, best.start_x);
    for (int i = 1; i * step <= farthest; ++i) {
      for (const double x : {best.start_x - i * step, best.start_x + i * step}) {
        if (std::holds_alternative<PlannedDig>(outcome)) return outcome;
        auto moved = dig_from(best.parameters, x);
        if (std::holds_alternative<PlannedDig>(moved)) outcome = std::move(moved);
      }
    }
    return outcome;
  }

 private:
  std::variant<PlannedDig, DigFailure> dig_from(const DigParameters& parameters, double x) const {
    const auto path = layout_.path_from(parameters, x);
    if (const auto* stop = std::get_if<Infeasible>(&path)) return DigFailure(*stop);
    return dig_of_path(model_.machine, *simulator_, ground_, std::get<DigPath>(path),
                       model_.search.objective);
  }

  const DigModel& model_;
  Terrain ground_;
  DigLayout layout_;
  std::unique_ptr<const SoilSimulator> simulator_;
};

void search_best(const DigModel& model, int digs, AssumptionResult& result) {
  PlanOptions options;
  options.method = PlanMethod::search;
  options.search = model.search;
  options.search.threads = 1;
  options.search.stop.evaluations = digs;
  options.simulator = model.simulator;
  options.cell_size = model.cell_size;
  const DigPlan plan = plan_dig(model.machine, model.soil, result.density_percent, options);
  result.best = plan.dig;
  result.failure = plan.reason;
  if (plan.search) result.worth = plan.search->worth;
}

/// Under the assumption, from the best dig of the reference on.
void search_assumed(const DigModel& reference, const Assumption& assumption,
                    const AssumptionResult& known, int digs, AssumptionResult& result) {
  DigModel model = reference;
  assumption.change(model);
  if (known.best) model.search.start = {{known.best->parameters, known.best->start_x}};
  try {
    search_best(model, digs, result);
  } catch (const Error& error) {
    result.failure = error.what();
  }
}

void dig_really(const Reference& reference, AssumptionResult& result) {
  if (!result.best) return;
  const auto outcome = reference.dig(*result.best);
  if (const auto* dig = std::get_if<PlannedDig>(&outcome)) {
    result.really = *dig;
  } else {
    result.failure = describe(std::get<DigFailure>(outcome));
  }
}

/// @param first, last  all of one density
template <typename Place>
void set_regrets(const DigObjective& objective, Place first, Place last) {
  const auto really = [&](const AssumptionResult& result) {
    return result.really ? objective.rank(*result.really) : 0.0;
  };
  double best = 0.0;
  for (Place at = first; at != last; ++at) best = std::max(best, really(*at));
  for (Place at = first; at != last && best > 0.0; ++at) {
    at->regret_percent = 100.0 * (1.0 - really(*at) / best);
  }
}

}  // namespace

std::vector<AssumptionResult> run_sensitivity(const DigModel& reference,
                                              const std::vector<Assumption>& assumptions,
                                              const SensitivityOptions& options) {
  const std::size_t densities = options.densities_percent.size();
  const std::size_t rows = 1 + assumptions.size();
  std::vector<AssumptionResult> results(densities * rows);
  for (std::size_t i = 0; i < results.size(); ++i) {
    AssumptionResult& result = results[i];
    result.density_percent = options.densities_percent[i / rows];
    result.factor = i % rows == 0 ? "reference" : assumptions[i % rows - 1].factor;
    result.level = i % rows == 0 ? "" : assumptions[i % rows - 1].level;
  }
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  const auto search = [&](std::size_t density, std::size_t row) {
    if (stopped) return;
    AssumptionResult& result = results[density * rows + row];
    if (row == 0) {
      search_best(reference, options.digs, result);
    } else {
      search_assumed(reference, assumptions[row - 1], results[density * rows], options.digs,
                     result);
    }
    dig_really(Reference(reference, result.density_percent), result);
    const double share = static_cast<double>(++done) / static_cast<double>(results.size());
    if (options.progress && !options.progress(share)) stopped = true;
  };
  parallel_for(densities, options.threads, [&](std::size_t density) { search(density, 0); });
  parallel_for(densities * assumptions.size(), options.threads, [&](std::size_t task) {
    search(task / assumptions.size(), 1 + task % assumptions.size());
  });
  if (stopped) return {};
  for (auto first = results.begin(); first != results.end();) {
    const auto last = first + static_cast<std::ptrdiff_t>(rows);
    set_regrets(reference.search.objective, first, last);
    first = last;
  }
  return results;
}

}  // namespace excavplan
