// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "shared/experiment_inputs.hpp"
#include "shared/experiment_results.hpp"
#include "shared/results.hpp"
#include "shared/sensitivity_results.hpp"
#include "shared/tool.hpp"
#ifdef EXCAVPLAN_STUDY  // they simulate surveys
#include "shared/field_results.hpp"
#include "shared/study_results.hpp"
#endif

namespace excavplan::tools {
namespace {

const About about = {
    "run-experiment",
    "repeats the paper's experiments, by default the simulated ones (section 3): digs along the "
    "fixed path, "
    "estimates the density from the height maps, digs along the path planned for that density and "
    "compares the two digs.",
    {{"run-experiment", "soft, medium and hard loam (10, 40, 80 %), paths from the library"},
     {"run-experiment --search --densities 0:10:100", "search for each path, at eleven densities"},
     {"run-experiment --preset field", "section 4: the field path, scans, fuel"},
     {"run-experiment --sensitivity", "best paths under other assumptions"},
     {"run-experiment --study results", "many conditions, one factor at a time, 30 runs each"},
     {"run-experiment --json", "all results as JSON"}}};

struct Inputs {
  std::string machine = "zx120";
  ExperimentInputs experiment;
  std::optional<std::string> report;
#ifdef EXCAVPLAN_STUDY
  StudyInputs study;
  FieldInputs field;
#endif
  /// A study has conditions of its own.
  bool is_study() const {
#ifdef EXCAVPLAN_STUDY
    return study.folder.has_value();
#else
    return false;
#endif
  }
  bool is_field() const {
#ifdef EXCAVPLAN_STUDY
    return field.chosen();
#else
    return false;
#endif
  }
  /// The paper's section 3.
  bool is_simulation() const { return !is_study() && !is_field() && !experiment.sensitivity; }
};

void declare(Arguments& arguments, Inputs& inputs) {
  ExperimentInputs& experiment = inputs.experiment;
  arguments.only_if({[&inputs] { return !inputs.is_study(); }, "a study has its own conditions"},
                    [&] {
                      declare_experiment(arguments, experiment);
                      arguments.only_if({[&inputs] { return inputs.is_simulation(); },
                                         "only the experiment of section 3 has a page"},
                                        [&] { arguments.report(inputs.report); });
                    });
  arguments.machine(inputs.machine);
#ifdef EXCAVPLAN_STUDY
  declare_study(arguments, inputs.study);
  arguments.only_if({[&inputs] { return !inputs.is_study() && !inputs.experiment.sensitivity; },
                     "a study or a sensitivity is no experiment of the paper"},
                    [&] { declare_field(arguments, inputs.field); });
#endif
  arguments.only_if({[&inputs] { return inputs.experiment.search || !inputs.is_simulation(); },
                     "nothing is searched without --search"},
                    [&] {
                      arguments.option("seed", experiment.seed, "seed of all that is drawn");
                      arguments.threads(experiment.threads, "");
                    });
}

Outcome work(const Inputs& inputs, Console& console) {
  check(inputs.experiment.method);
  const Machine machine = machine_named(inputs.machine);
  const ExperimentInputs& experiment = inputs.experiment;
#ifdef EXCAVPLAN_STUDY
  if (inputs.is_study()) {
    return study(machine, inputs.study, experiment.seed, experiment.threads, console);
  }
  if (inputs.is_field() && !experiment.sensitivity) {
    return field_experiment(machine, inputs.field, experiment, console);
  }
#endif
  if (experiment.sensitivity) return sensitivity(machine, experiment, console);
  const SoilKind soil = soil_named(experiment.soil);
  const DensityLaw law = law_of(experiment, machine, soil);
  const ExperimentOptions options = options_of(experiment, machine, soil);
  if (inputs.report && options.second == SecondGround::left) {
    usage_error("--report shows digs on fresh ground, not with --second left");
  }
  const std::vector<ExperimentCondition> conditions = conditions_of(experiment);
  const OptionNames names = experiment_option_names();
  std::vector<NamedExperiment> done;
  std::string failure;
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
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
