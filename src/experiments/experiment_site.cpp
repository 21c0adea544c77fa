// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "experiments/experiment_site.hpp"

#include <excavplan/simulation/dig_ground.hpp>

#include "simulation/checked_dig.hpp"

namespace excavplan {

ExperimentSite::ExperimentSite(const SoilKind& soil, double density_percent,
                               const ExperimentOptions& options)
    : soil_(options.dug_soil.value_or(soil)),
      density_percent_(density_percent),
      digs_(options.digs.value_or(options.plan.simulator)),
      options_(options) {}

std::unique_ptr<const SoilSimulator> ExperimentSite::simulator(const Machine& machine) const {
  return make_simulator(digs_, machine, soil_, density_percent_);
}

Terrain ExperimentSite::scene_ground(const Machine& machine) const {
  if (options_.ground) return *options_.ground;
  return undisturbed(flat_ground(scene_extent(machine, default_dump_point()),
                                 options_.plan.cell_size.value_or(usual_cell(machine))));
}

DigScene ExperimentSite::scene(const Machine& machine, const Terrain& ground,
                               const DigParameters& path, double start_x,
                               const DigPathOptions& rules) const {
  SceneOptions options;
  options.path = path;
  options.start_x = start_x;
  options.rules = rules;
  options.simulator = digs_;
  return run_scene(machine, soil_, density_percent_, ground, options);
}

}  // namespace excavplan
