// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

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
  Plots plots;
  std::optional<std::string> report;
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

/// Those of an experiment and that of a study.
std::vector<FigureName> figures_for(const Inputs& inputs) {
  std::vector<FigureName> names = names_of(experiment_figures(
      {[&inputs] { return !inputs.is_study(); }, "a --study has the figure study"}));
#ifdef EXCAVPLAN_STUDY
  names.push_back({"study",
                   "density error and gains of a --study by condition, with 95 % intervals",
                   {[&inputs] { return inputs.is_study(); }, "there is no --study"}});
#endif
  return names;
}

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
  declare_plots(arguments, inputs.plots, figures_for(inputs));
  arguments.report(inputs.report);
}

void add(const NamedExperiment& done, Outcome& outcome) {
  const auto& [condition, result] = done;
  outcome.json["conditions"].push_back(experiment_json(condition, result));
  outcome.lines.push_back(experiment_line(condition, result));
  if (result.held_because.empty()) return;
  const std::string why = ": the machine is held down, as on the fixed path ";
  outcome.warnings.push_back({"machine_held_down", condition + why + result.held_because});
}

void add_failure(const ExperimentCondition& condition, const std::string& why, Outcome& outcome) {
  outcome.json["conditions"].push_back(
      {{"name", condition.name}, {"density_percent", condition.density}, {"failure", why}});
  outcome.lines.push_back(condition.name + ": " + why);
  outcome.warnings.push_back({"condition_failed", condition.name + ": " + why});
}

Outcome work(const Inputs& inputs, Console& console) {
  const Machine machine = machine_named(inputs.machine);
  const ExperimentInputs& experiment = inputs.experiment;
#ifdef EXCAVPLAN_STUDY
  if (inputs.is_study()) {
    return study(machine, inputs.study, inputs.plots, experiment.seed, experiment.threads, console);
  }
#endif
  const SoilKind soil = soil_named(experiment.soil);
  const DensityLaw law = law_of(experiment, machine, soil);
  const ExperimentOptions options = options_of(experiment, machine, soil);
  if (inputs.report && options.second == SecondGround::left) {
    usage_error("--report shows digs on fresh ground, not with --second left");
  }
  const std::vector<ExperimentCondition> conditions = conditions_of(experiment);
  std::vector<NamedExperiment> done;
  std::string failure;
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  outcome.json["conditions"] = nlohmann::ordered_json::array();
  for (const ExperimentCondition& condition : conditions) {
    const auto count = static_cast<double>(outcome.json["conditions"].size());
    console.progress(count / static_cast<double>(conditions.size()), condition.name);
    try {
      done.push_back({condition.name, naming_options(cell_option, [&] {
                        return run_experiment(machine, soil, law, condition.density, options);
                      })});
      add(done.back(), outcome);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      failure = error.what();
      add_failure(condition, failure, outcome);
    }
  }
  if (done.empty()) throw Error(ErrorKind::bad_input, failure);
  outcome.json["law"] = law.name;
  outcome.json["regression"] = regression_json(machine, soil, options);
  outcome.lines.push_back(regression_line(outcome.json["regression"]));
  outcome.json.update(goal_json(options.plan.search.objective));
  outcome.json["start_rule"] =
      "fixed path: " + describe(StartRule()) + "; planned path: the start_rule of its condition";
  write_plots(inputs.plots, experiment_figures({}), {done, outcome.json["regression"], soil},
              outcome.lines);
  if (inputs.report) {
    Report report = experiment_report(machine, soil, options.plan, done);
    report.file = *inputs.report;
    outcome.report = std::make_shared<Report>(std::move(report));
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
