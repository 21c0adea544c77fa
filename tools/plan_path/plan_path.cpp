// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <excavplan/kit/kit_files.hpp>
#include <excavplan/planning/plan_dig.hpp>

#include "frame/stopwatch.hpp"
#include "frame/tool.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/simulator_inputs.hpp"
#include "plan_path/motion_inputs.hpp"
#include "plan_path/plan_ground.hpp"
#include "plan_path/plan_lines.hpp"
#include "plan_path/plan_plots.hpp"
#include "plan_path/search_inputs.hpp"
#include "results/plan_results.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "plan-path",
    "plans the dig with the highest mass of soil per energy of the whole cycle, or for another "
    "goal, at a given relative density, by look-up in a path library or by a search in the "
    "simulator.",
    {{"plan-path --density 40", "look up the path in the shipped library"},
     {"plan-path --density-from result.json --trajectory dig.csv",
      "use a result of estimate-density --json, write the joint trajectory"},
     {"plan-path --density 40 --joints -40deg,90deg,40deg --whole-cycle --trajectory dig.yaml",
      "from these joints over the dig, swing, dump and back, as a ROS 2 JointTrajectory"},
     {"plan-path --density 40 --search --terrain after.pcd", "search on scanned ground"},
     {"plan-path --density 40 --search --terrain run.mcap:/points@12s+2s --tf-frame base_link",
      "on ground as a robot recorded it"},
     {"plan-path --density 40 --search --ground ground.tif", "on ground as simulate-dig left it"},
     {"plan-path --site pit --search", "on a site that estimate-density --site remembers"},
     {"plan-path --density 40 --goal energy", "most mass per energy of the dig, as in the paper"},
     {"plan-path --density 40 --density-sd 8 --search",
      "the path of highest expected efficiency, and the value of knowing the density"}},
    true,
    true};

struct Inputs {
  PlanGroundInputs on;
  std::optional<std::string> library;
  bool search = false;
  std::string soil = "loam", machine = "zx120";
  SimulatorInputs simulator;
  SearchInputs dig_search;
  MotionInputs motion;
  Plots plots;
  Maps maps;
  std::optional<std::string> report;
};

SearchUse use_of(const Inputs& inputs) {
  if (inputs.search) return SearchUse::all;
  return inputs.on.is_level() ? SearchUse::none : SearchUse::start_only;
}

/// Whether any dig is simulated; a density from a file mostly has an error.
bool simulates(const Inputs& inputs) {
  const double sd = inputs.on.density.sd.value_or(inputs.on.density.file ? 1.0 : 0.0);
  return use_of(inputs) != SearchUse::none || sd > 0.0 || !is_default(inputs.simulator);
}

void declare(Arguments& arguments, Inputs& inputs) {
  declare_density(arguments, inputs.on.density);
  arguments.file(
      "library", inputs.library,
      "path library (default: that of machine-kit, or the shipped one, of machine, soil and goal)");
  arguments.flag("search", inputs.search, "search for the path instead of looking it up");
  declare_plan_ground(arguments, inputs.on);
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  declare_simulator(arguments, inputs.simulator);
  arguments.only_if({[&inputs] { return simulates(inputs); },
                     "nothing is simulated: a library has the digs of level ground"},
                    [&] { declare_cell(arguments, inputs.on.cell_size); });
  arguments.exclude("cell", {"ground"});
  declare_search(arguments, inputs.dig_search, [&inputs] { return use_of(inputs); });
  declare_motion(arguments, inputs.motion);
  const Arguments::Use searches = {[&inputs] { return inputs.search; }, "nothing is searched"};
  declare_plots(
      arguments, inputs.plots,
      names_of(plan_figures(searches, [&inputs] { return machine_named(inputs.machine); })));
  declare_maps(arguments, inputs.maps, plan_map_names());
  arguments.report(inputs.report);
}

PlanOptions options_of(const Inputs& inputs, const Machine& machine, const SoilKind& soil,
                       Console& console) {
  PlanOptions options;
  options.method = inputs.search ? PlanMethod::search : PlanMethod::library;
  options.search = search_options(inputs.dig_search, machine, use_of(inputs), console);
  options.library = inputs.library
                        ? std::make_shared<PathLibrary>(load_path_library(*inputs.library))
                        : kit_library(inputs.machine, machine, soil.name,
                                      inputs.dig_search.goal.numbers, options.search.objective);
  options.simulator = simulator_of(inputs.simulator, console);
  options.cell_size = inputs.on.cell_size;
  return options;
}

Outcome work(const Inputs& inputs, Console& console) {
  const Stopwatch watch;
  check(inputs.on);
  check(inputs.dig_search);
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  PlanGround on = plan_ground(inputs.motion, inputs.on, machine, soil);
  PlanOptions options = options_of(inputs, machine, soil, console);
  const auto area = ground_to_move_on(inputs.motion, inputs.on, on, machine, options);
  DigPlan plan =
      naming_options(search_option_names(), [&] { return plan_on(on, machine, soil, options); });
  Outcome outcome;
  outcome.stopped_early = plan.stopped;
  outcome.trustworthy = plan.trustworthy && plan.reason.empty();
  outcome.warnings = plan_warnings(plan, on.density_from, on.known());
  for (const auto& more : {goal_warnings(inputs.dig_search.goal, {machine}), on.warnings}) {
    outcome.warnings.insert(outcome.warnings.begin(), more.begin(), more.end());
  }
  outcome.lines = plan_lines(plan, on.density, soil.name, options.search.objective);
  outcome.json = plan_json(plan, on.density, options.search.objective);
  outcome.json.update({{"trustworthy", outcome.trustworthy},
                       {"soil", soil.name},
                       {"machine", machine.name},
                       {"simulator", options.simulator.word},
                       {"wall_time_s", watch.seconds()}});
  if (inputs.search) outcome.json["search"] = search_settings_json(machine, options.search);
  const PlanSite dug = {soil, on.density.percent, on.terrain, options.simulator};
  write_motion(inputs.motion, {machine, area, plan, options.search.objective}, outcome);
  inputs.on.terrain.scans->add_to(outcome);
  if (on.given) describe(inputs.on.state, *on.given, outcome);
  if (on.site) on.site->describe(on.density, outcome);
  if (plan.dig && inputs.report) plan.trajectory = dig_motion(inputs.motion, machine, plan);
  draw_plan(inputs.plots, inputs.report, {machine, plan, dug, options.search}, outcome);
  write_maps(
      inputs.maps, [&] { return plan_maps(machine, plan, dug); }, outcome);
  write_ground_after(inputs.on, on, {machine, plan, dug}, outcome);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
