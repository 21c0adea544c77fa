// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/kit/data_sheet_machine.hpp>
#include <excavplan/kit/kit_files.hpp>
#include <excavplan/kit/machine_kit.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "frame/stopwatch.hpp"
#include "frame/tool.hpp"
#include "inputs/goal_inputs.hpp"
#include "inputs/plots.hpp"
#include "machine_kit/kit_outcome.hpp"
#include "machine_kit/kit_plots.hpp"
#include "results/kit_results.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "machine-kit",
    "makes all that your own machine needs before plan-path: checks its file, draws where it "
    "reaches and how hard it digs, fits density laws and builds path libraries for the soils, in "
    "about a minute. plan-path, estimate-density and run-experiment find them by --machine.",
    {{"machine-kit --data-sheet sheet.json --output digger",
      "from a data sheet; then --machine digger"},
     {"machine-kit digger.json", "into the folder digger-kit"},
     {"plan-path --machine digger.json --density 40", "finds digger-kit beside it"},
     {"machine-kit digger.urdf --soil loam", "from a URDF, with digger.json beside it if there"},
     {"machine-kit zx200 --output kit", "of a shipped machine; then --machine kit"}},
    true,
    true};

struct Inputs {
  std::optional<std::string> machine;
  std::optional<std::string> data_sheet;
  std::optional<std::string> output;
  std::string soils = "loam,sand,clay,gravel";
  GoalInputs goal;
  std::string densities = "0:10:100";
  std::string slopes = "-15deg:7.5deg:15deg";
  KitOptions kit;
  std::uint64_t threads = 0;
  Plots plots;

  /// The file that tells the machine.
  std::string word() const { return data_sheet ? *data_sheet : *machine; }
  std::string folder() const { return output.value_or(default_kit(word())); }
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("machine", inputs.machine, "machine file, URDF, or a shipped machine");
  arguments.file("data-sheet", inputs.data_sheet,
                 "in place of the machine: a JSON file of the figures its maker publishes, from "
                 "which it is fitted");
  arguments.folder(
      "output", inputs.output,
      "folder for machine.json, pictures, laws and libraries (default: NAME-kit beside "
      "the machine)");
  arguments.text("soil", "NAME,..", inputs.soils, "loam, sand, clay, gravel or soil files");
  declare_goal(arguments, inputs.goal);
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities of the libraries [%], or a list a,b,c");
  arguments.text("slopes", "LIST", inputs.slopes,
                 "slopes of the libraries, as of build-path-library "
                 "[rad]");
  arguments.option("draws", inputs.kit.draws, "digs in drawn soils, for the scatter of a law");
  arguments.option("seed", inputs.kit.seed, "seed of the searches");
  arguments.threads(inputs.threads, "; same files for any");
  declare_plots(arguments, inputs.plots, names_of(kit_figures()));
}

KitOptions options_of(const Inputs& inputs, const Machine& machine, Console& console) {
  KitOptions options = inputs.kit;
  options.objective = objective_of(inputs.goal, {machine});
  options.densities_percent = parse_densities("--densities", inputs.densities);
  options.slopes = parse_series("--slopes", inputs.slopes, Quantity::angle);
  options.threads = static_cast<unsigned>(inputs.threads);
  options.progress = [&console](double done, const std::string& what) {
    console.progress(done, what);
    return !console.stop_requested();
  };
  return options;
}

/// Of a machine that digs.
void write_machine(const Inputs& inputs, const MachineFile& file, Outcome& outcome) {
  write_file(inputs.folder() + "/" + kit_machine, file.text);
  Plots plots;
  for (const char* figure : {"joints", "measures", "reach"}) {
    plots.files.push_back({figure, inputs.folder() + "/" + figure + ".svg"});
  }
  write_plots(plots, kit_figures(), file.machine, outcome.lines, outcome.warnings);
}

void make_kits(const Inputs& inputs, const MachineFile& file, Console& console, Outcome& outcome) {
  const std::vector<SoilKind> soils = soils_named(inputs.soils);
  const KitOptions options = options_of(inputs, file.machine, console);
  const std::string path = inputs.data_sheet ? *inputs.data_sheet : machine_path(*inputs.machine);
  const OptionNames names = {{"this dig", path + ": a dig of its size"},
                             {"machine kit: ", path + ": "}};
  for (const SoilKind& soil : soils) {
    const KitSoil kit =
        naming_options(names, [&] { return make_kit(file.machine, soil, options); });
    outcome.stopped_early = kit.stopped;
    if (kit.stopped) return;
    if (outcome.json["soils"].empty()) write_machine(inputs, file, outcome);
    add_kit(kit, file.machine, soil, inputs.folder(), outcome);
  }
}

FittedMachine told_machine(const Inputs& inputs) {
  if (inputs.machine.has_value() == inputs.data_sheet.has_value()) {
    usage_error("give either a machine or --data-sheet FILE");
  }
  if (inputs.data_sheet) return machine_from_data_sheet(load_data_sheet(*inputs.data_sheet));
  return {load_machine_file(machine_path(*inputs.machine)), {}};
}

Outcome work(const Inputs& inputs, Console& console) {
  const Stopwatch watch;
  const FittedMachine told = told_machine(inputs);
  const MachineFile& file = told.file;
  Outcome outcome = examined(file, inputs.folder());
  if (inputs.data_sheet) outcome.json["fitted"] = fitted_json(told.numbers);
  for (Warning& each : goal_warnings(inputs.goal, {file.machine})) {
    outcome.warnings.push_back(std::move(each));
  }
  outcome.json["soils"] = nlohmann::ordered_json::array();
  write_plots(inputs.plots, kit_figures(), file.machine, outcome.lines, outcome.warnings);
  in_folder(inputs.folder(), [&] { make_kits(inputs, file, console, outcome); });
  outcome.json["wall_time_s"] = watch.seconds();
  const bool by_folder = inputs.output || inputs.data_sheet;
  if (!outcome.stopped_early) {
    outcome.lines.push_back("next: plan-path --machine " +
                            (by_folder ? inputs.folder() : *inputs.machine) + " --density 40");
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
