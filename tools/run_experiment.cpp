// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <excavplan/data_files.hpp>
#include <excavplan/experiment/experiment.hpp>
#include <excavplan/simulation/calibration.hpp>

#include "shared/experiment_results.hpp"
#include "shared/goal_inputs.hpp"
#include "shared/results.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "run-experiment",
    "repeats the paper's simulation experiment (section 3): digs along the fixed path, "
    "estimates the density from the height maps, digs along the path planned for that density and "
    "compares the two digs.",
    {{"run-experiment", "soft, medium and hard loam (10, 40, 80 %), paths from the library"},
     {"run-experiment --search --densities 0:10:100", "search for each path, at eleven densities"},
     {"run-experiment --json", "all results as JSON"}}};

struct Inputs {
  std::string densities = "paper";
  DigParameters path = paper_fixed_path();
  std::string soil = "loam";
  std::string machine = "zx120";
  std::string simulator = default_simulator().word;
  std::optional<std::string> library;
  GoalInputs goal{info_of(DigObjective::Goal::energy).word};
  std::string law = "default";
  bool search = false;
  double cell_size = 0.05;
  std::uint64_t seed = 1;
  std::uint64_t threads = 0;
  std::optional<std::string> report;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c; \"paper\": soft 10, medium 40, hard 80");
  arguments.file("library", inputs.library,
                 "path library (default: the shipped one of machine, soil and goal)");
  arguments.text(
      "law", "NAME|FILE", inputs.law,
      "density law: default (that of machine, soil and fixed path), paper, or a law file");
  arguments.flag("search", inputs.search, "search for each path instead of looking it up");
  declare_goal(arguments, inputs.goal);
  arguments.option("path", inputs.path, "fixed path");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.simulator(inputs.simulator);
  arguments.option("cell", inputs.cell_size, Quantity::length, "cell size of the simulated ground");
  arguments.only_if({[&inputs] { return inputs.search; }, "nothing is searched without --search"},
                    [&] {
                      arguments.option("seed", inputs.seed, "seed of the searches");
                      arguments.threads(inputs.threads, "");
                    });
  arguments.report(inputs.report);
}

struct Condition {
  std::string name;
  double density = 0.0;
};

/// Ours: the densities of the paper's Table 1 are not published as text.
std::vector<Condition> conditions_of(const Inputs& inputs) {
  if (inputs.densities == "paper") return {{"soft", 10.0}, {"medium", 40.0}, {"hard", 80.0}};
  std::vector<Condition> conditions;
  for (const double density : parse_densities("--densities", inputs.densities)) {
    conditions.push_back({readable(density) + " %", density});
  }
  return conditions;
}

ExperimentOptions options_of(const Inputs& inputs, const Machine& machine, const SoilKind& soil) {
  ExperimentOptions options;
  options.fixed_path = inputs.path;
  PlanOptions& plan = options.plan;
  plan.method = inputs.search ? PlanMethod::search : PlanMethod::library;
  plan.search.objective = objective_of(inputs.goal);
  if (inputs.library || !inputs.search) {
    plan.library = std::make_shared<PathLibrary>(
        inputs.library ? load_path_library(*inputs.library)
                       : shipped_library(machine, soil, plan.search.objective));
  }
  plan.search.seed = inputs.seed;
  plan.search.threads = static_cast<unsigned>(inputs.threads);
  plan.simulator = simulator_of_word(inputs.simulator);
  plan.cell_size = inputs.cell_size;
  return options;
}

/// The default is the shipped one on the paper's path, on another one of digs along that.
DensityLaw law_of(const Inputs& inputs, const Machine& machine, const SoilKind& soil) {
  const bool own = inputs.law == "default";
  if (own && to_vector(inputs.path) != to_vector(paper_fixed_path())) {
    return law_of(calibrate_path(machine, soil, inputs.path));
  }
  const std::string name = own ? machine.name + "-" + soil.name : inputs.law;
  return load_density_law(shipped_or_file("laws", name));
}

Outcome work(const Inputs& inputs, Console& console) {
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  const DensityLaw law = law_of(inputs, machine, soil);
  const ExperimentOptions options = options_of(inputs, machine, soil);
  const std::vector<Condition> conditions = conditions_of(inputs);
  std::vector<NamedExperiment> done;
  Outcome outcome;
  outcome.warnings = unlike_law(law, machine.name, soil.name);
  outcome.json["conditions"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    console.progress(static_cast<double>(i) / static_cast<double>(conditions.size()),
                     conditions[i].name);
    const ExperimentResult result = naming_options(cell_option, [&] {
      return run_experiment(machine, soil, law, conditions[i].density, options);
    });
    outcome.json["conditions"].push_back(experiment_json(conditions[i].name, result));
    outcome.lines.push_back(experiment_line(conditions[i].name, result));
    done.push_back({conditions[i].name, result});
    if (result.held_because.empty()) continue;
    const std::string why = ": the machine is held down, as on the fixed path ";
    outcome.warnings.push_back(
        {"machine_held_down", conditions[i].name + why + result.held_because});
  }
  outcome.json["law"] = law.name;
  outcome.json.update(goal_json(options.plan.search.objective));
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
