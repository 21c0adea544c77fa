// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/experiment_report.hpp"

#include <excavplan/simulation/dig_ground.hpp>

#include "figures/experiment_figures.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan::tools {
namespace {

/// What digs of an experiment are dug in once more.
struct Rehearsal {
  const Machine& machine;
  const SoilSimulator& simulator;
  const Terrain& ground;
};

/// Adds a dig of the experiment and the ground that it leaves.
void add_dig(const std::string& name, const Rehearsal& in, const DigPath& path,
             ReportScene& scene) {
  DigOptions options;
  options.history = true;
  const DigResult dig = checked_dig(in.simulator, in.machine, in.ground, path, options);
  std::vector<ShownGround>& states = scene.areas.front().states;
  states.push_back({"after", dig.after(in.ground).surface()});
  scene.digs.push_back(played_dig(name, in.machine, path, dig));
  scene.digs.back().state = states.size() - 1;
}

}  // namespace

Report experiment_report(const Machine& machine, const SoilKind& soil, const PlanOptions& options,
                         const Experiments& experiments) {
  Report report;
  report.title = "Fixed path against planned path in " + soil.name;
  report.plot_always = true;
  report.scene.machine = machine;
  const Terrain ground =
      level_planning_ground(machine, options.cell_size.value_or(usual_cell(machine)));
  report.scene.areas = {{{{"before", ground.surface()}}}};
  for (const auto& [condition, result] : experiments.done) {
    Machine standing = machine;
    if (!result.held_because.empty()) standing.body.reset();
    const auto simulator =
        make_simulator(options.simulator, standing, soil, result.density_percent);
    const Rehearsal in = {standing, *simulator, ground};
    add_dig(condition + ", planned path", in, result.planned_path, report.scene);
    add_dig(condition + ", fixed path", in, result.fixed_path, report.scene);
  }
  for (std::size_t i = 0; i < experiments.done.size() && i < 6; ++i) {  // ours
    report.headline.push_back("conditions." + std::to_string(i) + ".gain_percent");
  }
  Figure plot = paths_figure(experiments);
  plot.rows.push_back(efficiency_figure(experiments).rows.front());
  set_plot(report, plot);
  report.note =
      "Ground and loads are those of the dig that is chosen, on level ground; the payload "
      "stays in the bucket.";
  return report;
}

}  // namespace excavplan::tools
