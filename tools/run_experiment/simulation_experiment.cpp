// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/simulation_experiment.hpp"

#include <memory>
#include <utility>

#include "results/experiment_results.hpp"
#include "results/results.hpp"

namespace excavplan::tools {

Outcome simulation_experiment(const Machine& machine, const ExperimentInputs& experiment,
                              const ExperimentPages& pages, Console& console) {
  const SoilKind soil = soil_named(experiment.soil);
  const DensityLaw law = law_of(experiment, machine, soil);
  const ExperimentOptions options = options_of(experiment, machine, soil, console);
  if (pages.report && options.second == SecondGround::left) {
    usage_error("--report shows digs on fresh ground, not with --second left");
  }
  const std::vector<ExperimentCondition> conditions = conditions_of(experiment);
  const OptionNames names = experiment_option_names();
  Experiments experiments;
  experiments.second = options.second;
  std::vector<NamedExperiment>& done = experiments.done;
  std::string failure;
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  for (Warning& each : goal_warnings(experiment.goal, {machine})) {
    outcome.warnings.push_back(std::move(each));
  }
  outcome.json["conditions"] = nlohmann::ordered_json::array();
  for (const ExperimentCondition& condition : conditions) {
    const auto count = static_cast<double>(outcome.json["conditions"].size());
    console.progress(count / static_cast<double>(conditions.size()), condition.name);
    try {
      done.push_back({condition.name, naming_options(names, [&] {
                        return run_experiment(machine, soil, law, condition.density, options);
                      })});
      add(done.back(), outcome);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      failure = error.what();
      experiments.failed.push_back({condition.name, condition.density, done.size()});
      add_failure(condition.name, condition.density, failure, outcome);
    }
  }
  if (done.empty()) throw Error(ErrorKind::bad_input, failure);
  outcome.json["law"] = law.name;
  outcome.json["regression"] = regression_json(machine, soil, options);
  outcome.lines.push_back(regression_line(outcome.json["regression"]));
  outcome.json.update(goal_json(options.plan.search.objective));
  if (experiment.search) {
    outcome.json["search"] = search_settings_json(machine, options.plan.search);
  }
  outcome.json["start_rule"] =
      "fixed path: " + describe(StartRule()) + "; planned path: the start_rule of its condition";
  write_plots(pages.plots, experiment_figures({}), {experiments, outcome.json["regression"], soil},
              outcome.lines, outcome.warnings);
  if (pages.report) {
    outcome.page =
        page_of(experiment_report(machine, soil, options.plan, experiments), *pages.report);
  }
  return outcome;
}

}  // namespace excavplan::tools
