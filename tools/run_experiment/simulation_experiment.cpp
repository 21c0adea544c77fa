// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/simulation_experiment.hpp"

#include <utility>

#include "inputs/goal_inputs.hpp"
#include "inputs/law_warnings.hpp"
#include "inputs/named_kinds.hpp"
#include "planning/planned_digs.hpp"
#include "report/report.hpp"
#include "results/experiment_results.hpp"
#include "results/plan_results.hpp"
#include "run_experiment/experiment_lines.hpp"
#include "run_experiment/experiment_plots.hpp"
#include "run_experiment/experiment_report.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan::tools {
namespace {

/// A machine in a soil, and how both digs of a condition are made.
struct Trial {
  const Machine& machine;
  const SoilKind& soil;
  const DensityLaw& law;
  const ExperimentOptions& options;
};

/// Digs in each condition; one that fails is in the result too.
/// @throws Error (bad_input) if all of them fail
Experiments dig_conditions(const Trial& trial, const std::vector<ExperimentCondition>& conditions,
                           Console& console, Outcome& outcome) {
  const OptionNames names = experiment_option_names();
  Experiments experiments;
  experiments.second = trial.options.second;
  std::string failure;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const ExperimentCondition& condition = conditions[i];
    console.progress(static_cast<double>(i) / static_cast<double>(conditions.size()),
                     condition.name);
    try {
      experiments.done.push_back({condition.name, naming_options(names, [&] {
                                    return run_experiment(trial.machine, trial.soil, trial.law,
                                                          condition.density, trial.options);
                                  })});
      add(experiments.done.back(), outcome);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      failure = error.what();
      experiments.failed.push_back({condition.name, condition.density, experiments.done.size()});
      add_failure(experiments.failed.back(), failure, outcome);
    }
  }
  if (experiments.done.empty()) throw Error(ErrorKind::bad_input, failure);
  return experiments;
}

/// The ground of --ground without its densities of the bank: those are the conditions'.
std::optional<GivenGround> experiment_ground(const GroundInput& input, const Trial& trial) {
  std::optional<GivenGround> given = given_ground(input, trial.machine, trial.soil, 0.0);
  if (!given) return given;
  given->density_percent.reset();
  given->terrain.bank_void_ratio.resize(0, 0);
  return given;
}

/// The ground after the planned dig of the last condition, its payload dumped.
void write_ground_after(const GroundInput& input, const GivenGround* given, const Trial& trial,
                        const Experiments& experiments) {
  if (!input.out) return;
  const ExperimentResult& last = experiments.done.back().result;
  const ExperimentOptions& options = trial.options;
  Machine machine = trial.machine;
  if (!last.held_because.empty()) machine.body.reset();
  const Terrain start =
      options.ground
          ? *options.ground
          : undisturbed(flat_ground(scene_extent(machine, default_dump_point()),
                                    options.plan.cell_size.value_or(usual_cell(machine))));
  const Terrain before =
      options.second == SecondGround::fresh
          ? start
          : first_dig(trial.machine, trial.soil, last.density_percent, options).after;
  const auto simulator =
      make_simulator(options.plan.simulator, machine, trial.soil, last.density_percent);
  DigOptions dig;
  dig.dump_at = default_dump_point();
  const Terrain after =
      checked_dig(*simulator, machine, before, last.planned_path, dig).after(before);
  write_ground(input, given, start, after, trial.soil);
}

}  // namespace

void declare_experiment_ground(Arguments& arguments, ExperimentInputs& inputs) {
  declare_ground(arguments, inputs.ground,
                 {{"cell", "report"}, "the planned dig of the last condition, with the heap"});
}

Outcome simulation_experiment(const Machine& machine, const ExperimentInputs& experiment,
                              const ExperimentPages& pages, Console& console) {
  const SoilKind soil = soil_named(experiment.soil);
  const DensityLaw law = law_of(experiment, machine, soil);
  ExperimentOptions options = options_of(experiment, machine, soil, console);
  if (pages.report && options.second == SecondGround::left) {
    usage_error("--report shows digs on fresh ground, not with --second left");
  }
  const Trial trial = {machine, soil, law, options};
  const auto given = experiment_ground(experiment.ground, trial);
  if (given) options.ground = given->terrain;
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  for (Warning& each : goal_warnings(experiment.goal, {machine})) {
    outcome.warnings.push_back(std::move(each));
  }
  outcome.json["conditions"] = nlohmann::ordered_json::array();
  const Experiments experiments =
      dig_conditions(trial, conditions_of(experiment), console, outcome);
  const DensityRegression regression = density_regression(machine, soil, options);
  outcome.json["law"] = law.name;
  outcome.json["regression"] = regression_json(regression);
  outcome.lines.push_back(regression_line(regression));
  outcome.json.update(goal_json(options.plan.search.objective));
  if (experiment.search) {
    outcome.json["search"] = search_settings_json(machine, options.plan.search);
  }
  outcome.json["start_rule"] =
      "fixed path: " + describe(StartRule()) + "; planned path: the start_rule of its condition";
  if (given) describe(experiment.ground, *given, outcome);
  write_ground_after(experiment.ground, given ? &*given : nullptr, trial, experiments);
  write_plots(pages.plots, experiment_figures({}), {experiments, regression, soil}, outcome.lines,
              outcome.warnings);
  if (pages.report) {
    outcome.page =
        page_of(experiment_report(machine, soil, options.plan, experiments), *pages.report);
  }
  return outcome;
}

}  // namespace excavplan::tools
