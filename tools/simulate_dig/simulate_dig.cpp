// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <tuple>

#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/results/force_history.hpp>
#include <excavplan/sensing/scene.hpp>

#include "base/files.hpp"
#include "figures/dig_figures.hpp"
#include "frame/stopwatch.hpp"
#include "frame/tool.hpp"
#include "inputs/dig_plots.hpp"
#include "inputs/maps.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/simulator_inputs.hpp"
#include "inputs/site.hpp"
#include "machine/dig_path_text.hpp"
#include "report/dig_report.hpp"
#include "results/scene_results.hpp"
#include "simulate_dig/block_inputs.hpp"
#include "simulate_dig/fuel_log.hpp"
#include "simulate_dig/scene_lines.hpp"
#include "simulate_dig/scene_scans.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "simulate-dig",
    "simulates one dig in soil of known density: payload, energy, joint loads and soil volumes. "
    "Optionally writes depth-camera scans of the ground before and after the dig.",
    {{"simulate-dig --density 40", "the paper's fixed path in medium loam"},
     {"simulate-dig --density 80 --path 43deg,0.2m,2.6m --plot dig.svg", "own path, with plot"},
     {"simulate-dig --density 40 --path-from plan.json", "the path that plan-path --json planned"},
     {"simulate-dig --density 40 --before b.pcd --after a.pcd --seed 7", "write a pair of scans"}}};

struct Inputs {
  double density = 0.0;
  std::optional<double> cell_size;
  SceneOptions scene;
  std::optional<DigParameters> path;
  TerrainInput terrain;
  std::string soil = "loam", machine = "zx120";
  SimulatorInputs simulator;
  std::uint64_t seed = 1;
  SceneScanInputs scans;
  FuelLogInputs fuel_log;
  BlockInputs blocks;
  Plots plots;
  Maps maps;
  std::optional<std::string> path_from, history, report;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.option("density", inputs.density, Quantity::percent, "relative density of the ground");
  arguments.require("density");
  arguments.option("path", inputs.path,
                   dig_path_form().names + " (default: the paper's " +
                       dig_path_argument(paper_fixed_path()) + ")");
  arguments.option("start", inputs.scene.start_x, Quantity::length,
                   "x at which the tip enters the ground (default: planned)");
  arguments.file("path-from", inputs.path_from,
                 "take path and start from this result of plan-path --json");
  arguments.exclude("path-from", {"path", "start"});
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  declare_simulator(arguments, inputs.simulator);
  declare_terrain(arguments, inputs.terrain);
  arguments.option("dump-at", inputs.scene.dump_at, "point at which the payload is dumped");
  declare_cell(arguments, inputs.cell_size);
  declare_scans(arguments, inputs.scans);
  inputs.blocks.declare(arguments);
  arguments.only_if(
      {[&inputs] { return inputs.blocks.broken || inputs.scans.any() || inputs.fuel_log.file; },
       "there are neither scans (--before, --after) nor --blocks nor a --fuel-log"},
      [&] { arguments.option("seed", inputs.seed, "seed of noise and blocks"); });
  inputs.fuel_log.declare(arguments);
  arguments.output("history", inputs.history, "write the loads of each step, CSV");
  declare_plots(arguments, inputs.plots,
                names_of(dig_figures([&inputs] { return machine_named(inputs.machine); })));
  declare_maps(arguments, inputs.maps, ground_map_names(3));
  arguments.report(inputs.report);
}

SceneOptions options_of(const Inputs& inputs, Console& console) {
  SceneOptions options = inputs.scene;
  options.path = inputs.path.value_or(options.path);
  options.simulator = simulator_of(inputs.simulator, console);
  options.history = true;
  options.blocks = inputs.blocks.with_seed(inputs.seed);
  if (!inputs.path_from) return options;
  std::tie(options.path, options.start_x) = read_planned_path(*inputs.path_from);
  options.rules = rules_for_planned_path();
  return options;
}

void write_files(const Inputs& inputs, const Machine& machine, const DigScene& scene,
                 Outcome& outcome) {
  write_scans(inputs.scans, scene, inputs.seed);
  inputs.fuel_log.write(machine, scene, inputs.seed);
  if (inputs.history) write_file(*inputs.history, force_history_csv(machine, scene));
  const std::string title = scene_title(scene);
  const DugDig dug = {machine,
                      scene.path,
                      scene.dig,
                      boom_plane_profile(scene.before),
                      boom_plane_profile(scene.after),
                      title};
  write_plots(inputs.plots, dig_figures({}), dug, outcome.lines, outcome.warnings);
  write_maps(
      inputs.maps, [&] { return scene_maps(scene); }, outcome);
  if (!inputs.report) return;
  Report report = scene_report(machine, scene);
  report.title = title;
  report.plot = to_svg(lay_out(section_figure(dug)));
  outcome.page = page_of(std::move(report), *inputs.report);
}

Outcome work(const Inputs& inputs, Console& console) {
  const SceneOptions options = options_of(inputs, console);
  check_scans(inputs.scans);
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  Site site = make_site(inputs.terrain, scene_extent(machine, options.dump_at),
                        inputs.cell_size.value_or(usual_cell(machine)));
  const Stopwatch watch;
  const OptionNames names = {{"the dump point", "--dump-at"}};
  const DigScene scene = naming_options(
      names, [&] { return run_scene(machine, soil, inputs.density, site.ground, options); });
  Outcome outcome;
  outcome.json = scene_json(machine, scene);
  outcome.json["wall_time_s"] = watch.seconds();
  outcome.lines = scene_lines(machine, scene);
  outcome.warnings = std::move(site.warnings);
  outcome.warnings.insert(outcome.warnings.end(), scene.warnings.begin(), scene.warnings.end());
  for (Warning& each : outcome.warnings) each.message = with_option_names(each.message, names);
  if (scene.dig.stall)
    outcome.warnings.emplace_back(WarningCode::stalled, describe(*scene.dig.stall));
  write_files(inputs, machine, scene, outcome);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
