// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "shared/experiment_inputs.hpp"
#include "shared/experiment_results.hpp"
#include "shared/results.hpp"
#include "shared/tool.hpp"
#ifdef EXCAVPLAN_STUDY  // it simulates surveys
#include "shared/study_results.hpp"
#endif

namespace excavplan::tools {
namespace {

const About about = {
    "run-experiment",
    "repeats the paper's simulation experiment (section 3): digs along the fixed path, "
    "estimates the density from the height maps, digs along the path planned for that density and "
    "compares the two digs.",
    {{"run-experiment", "soft, medium and hard loam (10, 40, 80 %), paths from the library"},
     {"run-experiment --search --densities 0:10:100", "search for each path, at eleven densities"},
     {"run-experiment --study results", "many conditions, one factor at a time, 30 runs each"},
     {"run-experiment --json", "all results as JSON"}}};

struct Inputs {
  std::string machine = "zx120";
  ExperimentInputs experiment;
#ifdef EXCAVPLAN_STUDY
  StudyInputs study;
#endif
  /// A study has conditions of its own.
  bool is_study() const {
#ifdef EXCAVPLAN_STUDY
    return study.folder.has_value();
#else
    return false;
#endif
  }
};

void declare(Arguments& arguments, Inputs& inputs) {
  ExperimentInputs& experiment = inputs.experiment;
  arguments.only_if({[&inputs] { return !inputs.is_study(); }, "a study has its own conditions"},
                    [&] { declare_experiment(arguments, experiment); });
  arguments.machine(inputs.machine);
#ifdef EXCAVPLAN_STUDY
  declare_study(arguments, inputs.study);
#endif
  arguments.only_if({[&inputs] { return inputs.experiment.search || inputs.is_study(); },
                     "nothing is searched without --search"},
                    [&] {
                      arguments.option("seed", experiment.seed, "seed of searches and of a study");
                      arguments.threads(experiment.threads, "");
                    });
}

/// Adds the results of one condition. @return why it has none; empty if it has
std::string add_condition(const ExperimentCondition& condition,
                          const std::function<ExperimentResult()>& run, Outcome& outcome) {
  nlohmann::ordered_json& conditions = outcome.json["conditions"];
  try {
    const ExperimentResult result = naming_options(cell_option, run);
    conditions.push_back(experiment_json(condition.name, result));
    outcome.lines.push_back(experiment_line(condition.name, result));
    if (!result.held_because.empty()) {
      outcome.warnings.push_back(
          {"machine_held_down", condition.name +
                                    ": the machine is held down, as on the fixed path " +
                                    result.held_because});
    }
    return {};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    conditions.push_back({{"name", condition.name},
                          {"density_percent", condition.density},
                          {"failure", error.what()}});
    outcome.lines.push_back(condition.name + ": " + error.what());
    outcome.warnings.push_back({"condition_failed", condition.name + ": " + error.what()});
    return error.what();
  }
}

Outcome work(const Inputs& inputs, Console& console) {
  const Machine machine = machine_named(inputs.machine);
  const ExperimentInputs& experiment = inputs.experiment;
#ifdef EXCAVPLAN_STUDY
  if (inputs.is_study()) {
    return study(machine, inputs.study, experiment.seed, experiment.threads, console);
  }
#endif
  const SoilKind soil = soil_named(experiment.soil);
  const DensityLaw law = law_of(experiment, machine, soil);
  const ExperimentOptions options = options_of(experiment, machine, soil);
  const std::vector<ExperimentCondition> conditions = conditions_of(experiment);
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  outcome.json["conditions"] = nlohmann::ordered_json::array();
  std::vector<std::string> failures;
  for (const ExperimentCondition& condition : conditions) {
    const auto done = static_cast<double>(outcome.json["conditions"].size());
    console.progress(done / static_cast<double>(conditions.size()), condition.name);
    const std::string failure = add_condition(
        condition, [&] { return run_experiment(machine, soil, law, condition.density, options); },
        outcome);
    if (!failure.empty()) failures.push_back(failure);
  }
  if (failures.size() == conditions.size()) throw Error(ErrorKind::bad_input, failures.front());
  outcome.json["law"] = law.name;
  outcome.json["regression"] = regression_json(machine, soil, options);
  outcome.lines.push_back(regression_line(outcome.json["regression"]));
  outcome.json.update(goal_json(options.plan.search.objective));
  outcome.json["start_rule"] =
      "fixed path: " + describe(StartRule()) + "; planned path: the start_rule of its condition";
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
