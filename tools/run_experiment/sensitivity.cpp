// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/sensitivity.hpp"

#include <mutex>

#include <excavplan/experiments/sensitivity.hpp>

#include "base/text.hpp"
#include "results/results.hpp"

namespace excavplan::tools {
namespace {

using nlohmann::ordered_json;

std::string row_line(const AssumptionResult& row, const DigObjective& objective) {
  std::string line = row.factor + (row.level.empty() ? "" : ", " + row.level) + "; " +
                     readable(row.density_percent) + " %: ";
  if (!row.best) return line + row.failure;
  line += path_text(*row.best) + ", " + worth_text(objective, row.worth);
  if (!row.really) return line + "; in the reference: " + row.failure;
  return line + "; in the reference " + worth_text(objective, objective.worth(*row.really)) + ", " +
         decimals(row.regret_percent, 1) + " % below the best";
}

}  // namespace

Outcome sensitivity(const Machine& machine, const ExperimentInputs& inputs, Console& console) {
  DigModel reference;
  reference.machine = machine;
  reference.soil = soil_named(inputs.soil);
  reference.simulator = simulator_of(inputs.simulator, console);
  reference.search.objective = objective_of(inputs.goal, {machine});
  reference.search.seed = inputs.seed;
  reference.cell_size = inputs.cell_size.value_or(usual_cell(machine));
  SensitivityOptions options;
  options.threads = static_cast<unsigned>(inputs.threads);
  if (inputs.method.evaluations > 0) options.digs = inputs.method.evaluations;
  options.densities_percent.clear();
  for (const ExperimentCondition& condition : conditions_of(inputs)) {
    options.densities_percent.push_back(condition.density);
  }
  std::mutex one_line;
  options.progress = [&](double done) {
    const std::lock_guard<std::mutex> lock(one_line);
    console.progress(done, "best paths under other assumptions");
    return !console.stop_requested();
  };
  const auto rows = naming_options(experiment_option_names(), [&] {
    return run_sensitivity(reference, our_assumptions(), options);
  });
  const DigObjective& objective = reference.search.objective;
  Outcome outcome;
  outcome.warnings = goal_warnings(inputs.goal, {machine});
  outcome.json["sensitivity"] = ordered_json::array();
  for (const AssumptionResult& row : rows) {
    outcome.json["sensitivity"].push_back(assumption_json(row, objective));
    outcome.lines.push_back(row_line(row, objective));
  }
  outcome.json.update(goal_json(objective));
  outcome.json.update({{"worth_unit", info_of(objective.goal).unit},
                       {"soil", reference.soil.name},
                       {"seed", inputs.seed},
                       {"evaluations", options.digs}});
  return outcome;
}

}  // namespace excavplan::tools
