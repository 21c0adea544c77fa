// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "study/study_row.hpp"

#include <utility>
#include <variant>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"
#include "planning/dig_layout.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

Terrain level_scene_ground(const Machine& machine, double cell_size) {
  return undisturbed(flat_ground(scene_extent(machine, default_dump_point()), cell_size));
}

}  // namespace

DigRow::DigRow(const Machine& machine, const SoilKind& soil, double density_percent,
               const ExperimentOptions& options)
    : machine_(machine),
      soil_(soil),
      dug_soil_(options.dug_soil.value_or(soil)),
      density_(density_percent),
      options_(options),
      digs_(options.digs.value_or(options.plan.simulator)),
      ground_(options.ground ? *options.ground
                             : level_scene_ground(machine, options.plan.cell_size)) {}

DigScene DigRow::dug(const Terrain& ground, const DigParameters& path,
                     std::optional<double> start_x) const {
  SceneOptions options;
  options.path = path;
  options.start_x = start_x;
  options.rules = rules_for_planned_path();
  options.simulator = digs_;
  DigScene scene = run_scene(machine_, dug_soil_, density_, ground, options);
  if (scene.dig.stall) throw Error(ErrorKind::bad_input, describe(DigFailure(*scene.dig.stall)));
  return scene;
}

Terrain DigRow::without_heap(const DigScene& scene) const {
  const auto simulator = make_simulator(digs_, machine_, dug_soil_, density_);
  return checked_dig(*simulator, machine_, scene.before, scene.path, {}).after(scene.before);
}

void DigRow::add(const DigScene& scene, RowTotal& total) const {
  PlannedDig dig{scene.path.parameters,    scene.path.start_x,     scene.dig.payload_mass,
                 scene.dig.payload_volume, scene.dig.energy.total, scene.duration};
  add_cycle(dig, machine_, scene.path, options_.plan.search.objective);
  total.mass += dig.payload_mass;
  total.energy += dig.energy;
  total.cycle_energy += dig.cycle_energy;
}

RowTotal DigRow::fixed(int digs) const {
  RowTotal total;
  Terrain ground = ground_;
  for (int i = 0; i < digs; ++i) {
    const auto laid =
        DigLayout(machine_, ground).path(options_.fixed_path, StartRule::Kind::least_work);
    if (const auto* infeasible = std::get_if<Infeasible>(&laid)) {
      throw Error(ErrorKind::bad_input,
                  "fixed path, dig " + std::to_string(i + 1) + ": " + infeasible->message);
    }
    const DigScene scene = dug(ground, options_.fixed_path, std::get<DigPath>(laid).start_x);
    add(scene, total);
    ground = without_heap(scene);
  }
  return total;
}

RowTotal DigRow::planned(int digs, const RelativeDensity& first, RelativeDensity* last) const {
  RowTotal total;
  Terrain ground = ground_;
  RelativeDensity estimate = first;
  for (int i = 0; i < digs; ++i) {
    const Terrain seen = options_.seen ? options_.seen(ground) : ground;
    const DigPlan plan = plan_dig(machine_, soil_, estimate.percent, seen, options_.plan);
    if (!plan.dig) {
      throw Error(ErrorKind::bad_input,
                  "planned path, dig " + std::to_string(i + 1) + ": " + plan.reason);
    }
    const DigScene scene = dug(ground, plan.dig->parameters, plan.dig->start_x);
    add(scene, total);
    estimate = options_.survey(scene);
    ground = without_heap(scene);
  }
  if (last) *last = estimate;
  return total;
}

}  // namespace excavplan
