// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <tuple>

#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/sensing/scene.hpp>

#include "frame/stopwatch.hpp"
#include "frame/tool.hpp"
#include "inputs/dig_plots.hpp"
#include "inputs/ground.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/simulator_inputs.hpp"
#include "inputs/site.hpp"
#include "machine/dig_path_text.hpp"
#include "results/scene_results.hpp"
#include "simulate_dig/block_inputs.hpp"
#include "simulate_dig/scene_files.hpp"
#include "simulate_dig/scene_lines.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "simulate-dig",
    "simulates one dig in soil of known density: payload, energy, joint loads and soil volumes. "
    "Optionally writes depth-camera scans of the ground before and after the dig.",
    {{"simulate-dig --density 40", "the paper's fixed path in medium loam"},
     {"simulate-dig --density 40 --ground one.tif --ground-out two.tif", "from dig to dig"},
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
  GroundInput ground;
  BlockInputs blocks;
  SceneFiles files;
  std::optional<std::string> path_from;
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
  declare_ground(arguments, inputs.ground, {terrain_options({"cell"}), "the dig, with the heap"});
  declare_base(arguments, inputs.ground);
  declare_scans(arguments, inputs.files.scans);
  inputs.blocks.declare(arguments);
  arguments.exclude("ground-out", {"blocks"});
  arguments.only_if({[&inputs] {
                       return inputs.blocks.broken || inputs.files.scans.any() ||
                              inputs.files.fuel_log.file;
                     },
                     "there are neither scans (--before, --after) nor --blocks nor a --fuel-log"},
                    [&] { arguments.option("seed", inputs.seed, "seed of noise and blocks"); });
  inputs.files.fuel_log.declare(arguments);
  arguments.output("history", inputs.files.history, "write the loads of each step, CSV");
  declare_plots(arguments, inputs.files.plots,
                names_of(dig_figures([&inputs] { return machine_named(inputs.machine); })));
  declare_maps(arguments, inputs.files.maps, ground_map_names(3));
  arguments.report(inputs.files.report);
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

/// Where the payload can be put: a given ground may end before the default place.
void place_heap(const GivenGround& given, SceneOptions& options, Outcome& outcome) {
  const Eigen::Vector2d& at = options.dump_at;
  const bool is_known = std::isfinite(height_at(given.terrain.surface(), at.x(), at.y()));
  options.dumps = is_known || at != default_dump_point();
  if (options.dumps) return;
  outcome.lines.emplace_back(
      "payload      stays in the bucket: the ground is not known where it is dumped by default; "
      "--dump-at");
}

Outcome work(const Inputs& inputs, Console& console) {
  SceneOptions options = options_of(inputs, console);
  check_scans(inputs.files.scans);
  Machine machine = machine_named(inputs.machine);
  if (inputs.path_from) machine = machine_for_planned_path(std::move(machine));
  const SoilKind soil = soil_named(inputs.soil);
  Outcome outcome;
  const auto given = given_ground(inputs.ground, machine, soil, inputs.density);
  if (given) place_heap(*given, options, outcome);
  Site site = given ? Site{given->terrain, {}}
                    : make_site(inputs.terrain, scene_extent(machine, options.dump_at),
                                inputs.cell_size.value_or(usual_cell(machine)));
  const Stopwatch watch;
  const OptionNames names = {{"the dump point", "--dump-at"}};
  const DigScene scene = naming_options(
      names, [&] { return run_scene(machine, soil, inputs.density, site.ground, options); });
  outcome.json = scene_json(machine, scene);
  outcome.json["wall_time_s"] = watch.seconds();
  const auto lines = scene_lines(machine, scene);
  outcome.lines.insert(outcome.lines.begin(), lines.begin(), lines.end());
  if (given) describe(inputs.ground, *given, outcome);
  outcome.warnings = std::move(site.warnings);
  outcome.warnings.insert(outcome.warnings.end(), scene.warnings.begin(), scene.warnings.end());
  inputs.terrain.scans->add_to(outcome);
  for (Warning& each : outcome.warnings) each.message = with_option_names(each.message, names);
  if (scene.dig.stall)
    outcome.warnings.emplace_back(WarningCode::stalled, describe(*scene.dig.stall));
  SceneFiles files = inputs.files;
  files.scans.base = inputs.ground.base;
  write_files(files, machine, scene, inputs.seed, outcome);
  write_ground(inputs.ground, given ? &*given : nullptr, scene.before, scene.after, soil);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
