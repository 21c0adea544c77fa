// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/plots.hpp"
#include "run_experiment/experiment_inputs.hpp"
#include "run_experiment/experiment_plots.hpp"
#include "run_experiment/field_experiment.hpp"
#include "run_experiment/sensitivity.hpp"
#include "run_experiment/simulation_experiment.hpp"
#include "run_experiment/study.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "run-experiment",
    "repeats the paper's experiments, by default the simulated ones (section 3): digs along the "
    "fixed path, estimates the density from the height maps, digs along the path planned for that "
    "density and compares the two digs.",
    {{"run-experiment", "soft, medium and hard loam (10, 40, 80 %), paths from the library"},
     {"run-experiment --search --densities 0:10:100", "search for each path, at eleven densities"},
     {"run-experiment --preset field", "section 4: the field path, scans, fuel"},
     {"run-experiment --sensitivity", "best paths under other assumptions"},
     {"run-experiment --study results", "many conditions, one factor at a time, 30 runs each"},
     {"run-experiment --json", "all results as JSON"}}};

struct Inputs {
  ExperimentInputs experiment;
  Plots plots;
  std::optional<std::string> report;
  StudyInputs study;
  FieldInputs field;
  /// A study has conditions of its own.
  bool is_study() const { return study.folder.has_value(); }
  bool is_field() const { return field.chosen(); }
  /// The paper's section 3.
  bool is_simulation() const { return !is_study() && !is_field() && !experiment.sensitivity; }
};

void require_one_experiment(const Inputs& inputs) {
  std::string given;
  for (const auto& [is_chosen, name] : {std::pair(inputs.is_study(), "--study"),
                                        std::pair(inputs.experiment.sensitivity, "--sensitivity"),
                                        std::pair(inputs.is_field(), "--preset field")}) {
    if (!is_chosen) continue;
    if (!given.empty()) usage_error(given + " and " + name + " are two experiments: give one");
    given = name;
  }
}

/// Those of an experiment and that of a study.
std::vector<FigureName> figures_for(const Inputs& inputs) {
  std::vector<FigureName> names = names_of(experiment_figures(
      {[&inputs] { return inputs.is_simulation(); }, "only the experiment of section 3 has it"}));
  names.push_back({"study",
                   "density error and gains of a --study by condition, with 95 % intervals",
                   {[&inputs] { return inputs.is_study(); }, "there is no --study"}});
  return names;
}

void declare(Arguments& arguments, Inputs& inputs) {
  ExperimentInputs& experiment = inputs.experiment;
  arguments.only_if({[&inputs] { return !inputs.is_study(); }, "a study has its own conditions"},
                    [&] {
                      declare_experiment(arguments, experiment);
                      arguments.only_if({[&inputs] { return inputs.is_simulation(); },
                                         "only the experiment of section 3 has a page"},
                                        [&] { arguments.report(inputs.report); });
                      arguments.only_if({[&inputs] { return inputs.is_simulation(); },
                                         "only the experiment of section 3 digs on it"},
                                        [&] { declare_experiment_ground(arguments, experiment); });
                    });
  arguments.machine(inputs.experiment.machine);
  declare_study(arguments, inputs.study);
  arguments.only_if({[&inputs] { return !inputs.is_study() && !inputs.experiment.sensitivity; },
                     "a study or a sensitivity is no experiment of the paper"},
                    [&] { declare_field(arguments, inputs.field); });
  arguments.only_if({[&inputs] { return inputs.experiment.search || !inputs.is_simulation(); },
                     "nothing is searched without --search"},
                    [&] {
                      arguments.option("seed", experiment.seed, "seed of all that is drawn");
                      arguments.threads(experiment.threads, "");
                    });
  declare_plots(arguments, inputs.plots, figures_for(inputs));
}

Outcome work(const Inputs& inputs, Console& console) {
  require_one_experiment(inputs);
  check(inputs.experiment.method);
  const Machine machine = machine_named(inputs.experiment.machine);
  const ExperimentInputs& experiment = inputs.experiment;
  if (inputs.is_study()) {
    return study(machine, inputs.study, inputs.plots,
                 {experiment.seed, static_cast<unsigned>(experiment.threads)}, console);
  }
  if (inputs.is_field()) return field_experiment(machine, inputs.field, experiment, console);
  if (experiment.sensitivity) return sensitivity(machine, experiment, console);
  return simulation_experiment(machine, experiment, {inputs.plots, inputs.report}, console);
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
