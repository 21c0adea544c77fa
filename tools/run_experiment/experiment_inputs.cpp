// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/experiment_inputs.hpp"

#include <memory>

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/experiments/sensitivity.hpp>
#include <excavplan/kit/kit_files.hpp>

#include "base/text.hpp"
#include "frame/console.hpp"
#include "inputs/site.hpp"

namespace excavplan::tools {
namespace {

/// What a search for the best paths alone has no use for.
void declare_digs(Arguments& arguments, ExperimentInputs& inputs) {
  arguments.file(
      "library", inputs.library,
      "path library (default: that of machine-kit, or the shipped one, of machine, soil and goal)");
  arguments.text("law", "NAME|FILE", inputs.law,
                 "density law: default (that of machine and soil, or with --path one of digs along "
                 "that), paper, or a law file");
  arguments.flag("search", inputs.search, "search for each path instead of looking it up");
  arguments.only_if({[&inputs] { return inputs.search; }, "nothing is searched without --search"},
                    [&] { declare_search_method(arguments, inputs.method); });
  arguments.option("path", inputs.path, "fixed path (default: that of the paper)");
  arguments.choice("second", inputs.second, {"fresh", "left"},
                   "ground of the second dig: fresh, or as the first dig left it");
}

}  // namespace

void declare_experiment(Arguments& arguments, ExperimentInputs& inputs) {
  arguments.flag("sensitivity", inputs.sensitivity,
                 "search the best path under each assumption of ours on machine, soil and path "
                 "rules, one at a time, and what it is worth without it");
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c; \"paper\": soft 10, medium 40, hard 80");
  arguments.only_if({[&inputs] { return !inputs.sensitivity; }, "--sensitivity has no use for it"},
                    [&] { declare_digs(arguments, inputs); });
  arguments.only_if({[&inputs] { return inputs.search || inputs.sensitivity; },
                     "nothing is searched without --search"},
                    [&] {
                      declare_evaluations(arguments, inputs.method,
                                          "600, with --method paper as many as its generations "
                                          "take, with --sensitivity " +
                                              std::to_string(SensitivityOptions{}.digs));
                    });
  declare_goal(arguments, inputs.goal);
  arguments.soil(inputs.soil);
  declare_simulator(arguments, inputs.simulator);
  declare_cell(arguments, inputs.cell_size);
}

OptionNames experiment_option_names() {
  OptionNames names = cell_option();
  names.insert(names.end(), search_option_names().begin(), search_option_names().end());
  return names;
}

std::string condition_text(const ExperimentCondition& condition) {
  const std::string density = readable(condition.density) + " %";
  return (condition.name == density ? "" : condition.name + ": ") + "density " + density;
}

/// Ours: the densities of the paper's Table 1 are not published as text.
std::vector<ExperimentCondition> conditions_of(const ExperimentInputs& inputs) {
  if (inputs.densities == "paper") return {{"soft", 10.0}, {"medium", 40.0}, {"hard", 80.0}};
  std::vector<ExperimentCondition> conditions;
  for (const double density : parse_densities("--densities", inputs.densities)) {
    conditions.push_back({readable(density) + " %", density});
  }
  return conditions;
}

ExperimentOptions options_of(const ExperimentInputs& inputs, const Machine& machine,
                             const SoilKind& soil, Console& console) {
  ExperimentOptions options;
  options.fixed_path = inputs.path.value_or(options.fixed_path);
  PlanOptions& plan = options.plan;
  plan.method = inputs.search ? PlanMethod::search : PlanMethod::library;
  plan.search.objective = objective_of(inputs.goal, {machine});
  if (!inputs.library) {
    plan.library =
        kit_library(inputs.machine, machine, soil.name, inputs.goal.numbers, plan.search.objective);
  }
  if (inputs.library || (!inputs.search && !plan.library)) {
    plan.library = std::make_shared<PathLibrary>(
        inputs.library ? load_path_library(*inputs.library)
                       : shipped_library(machine, soil, plan.search.objective));
  }
  if (inputs.search) apply(inputs.method, plan.search);
  plan.search.seed = inputs.seed;
  plan.search.threads = static_cast<unsigned>(inputs.threads);
  plan.simulator = simulator_of(inputs.simulator, console);
  plan.cell_size = inputs.cell_size;
  if (inputs.second == "left") options.second = SecondGround::left;
  return options;
}

DensityLaw law_of(const ExperimentInputs& inputs, const Machine& machine, const SoilKind& soil) {
  const bool own = inputs.law == "default";
  if (own && inputs.path && to_vector(*inputs.path) != to_vector(paper_fixed_path())) {
    return law_of(calibrate_path(machine, soil, *inputs.path));
  }
  if (own) {
    if (const auto kit = kit_law(inputs.machine, machine, soil.name)) return load_density_law(*kit);
  }
  const std::string name = own ? machine.name + "-" + soil.name : inputs.law;
  return load_density_law(shipped_or_file("laws", name));
}

}  // namespace excavplan::tools
