// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "experiments/study_row.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

constexpr int most_attempts = 3;  // at a dig that stalls; ours

}  // namespace

DigRow::DigRow(const Machine& machine, const SoilKind& soil, double density_percent,
               const ExperimentOptions& options)
    : machine_(machine),
      soil_(soil),
      options_(options),
      site_(soil, density_percent, options),
      simulator_(site_.simulator(machine)),
      ground_(site_.scene_ground(machine)) {}

DigScene DigRow::dug(const Terrain& ground, const DigParameters& path, double start_x) const {
  return site_.scene(machine_, ground, path, start_x, rules_for_planned_path());
}

Terrain DigRow::without_heap(const DigScene& scene) const {
  return checked_dig(*simulator_, machine_, scene.before, scene.path, {}).after(scene.before);
}

void DigRow::add(const DigScene& scene, RowTotal& total) const {
  PlannedDig dig{scene.path.parameters,    scene.path.start_x,     scene.dig.payload_mass,
                 scene.dig.payload_volume, scene.dig.energy.total, scene.duration};
  add_cycle(dig, machine_, scene.path, options_.plan.search.objective);
  ++total.digs;
  total.mass += dig.payload_mass;
  total.energy += dig.energy;
  total.cycle_energy += dig.cycle_energy;
}

/// Where the fixed path lifts most, as an operator would choose; nothing if it stalls everywhere.
std::optional<double> DigRow::fullest_start(const Terrain& ground) const {
  const DigLayout layout(machine_, ground);
  std::optional<double> best;
  double most = 0.0;
  for (const double x : starts_along_reach(machine_)) {
    const auto laid = layout.path_from(options_.fixed_path, x);
    const auto* path = std::get_if<DigPath>(&laid);
    if (!path) continue;
    const auto outcome = dig_of_path(machine_, *simulator_, ground, *path);
    const auto* dig = std::get_if<PlannedDig>(&outcome);
    if (!dig || dig->payload_mass <= most) continue;
    most = dig->payload_mass;
    best = x;
  }
  return best;
}

RowTotal DigRow::fixed(int digs) const {
  RowTotal total;
  Terrain ground = ground_;
  while (total.digs < digs) {
    const std::optional<double> start_x = fullest_start(ground);
    if (!start_x) break;
    const DigScene scene = dug(ground, options_.fixed_path, *start_x);
    add(scene, total);
    ground = without_heap(scene);
  }
  if (total.digs == 0) throw Error(ErrorKind::bad_input, "the fixed path cannot be dug");
  return total;
}

/// Where the machine stalls in soil harder than it was estimated, the dig is planned again for soil
/// harder by a standard deviation.
DigScene DigRow::dug_as_planned(const Terrain& ground, const RelativeDensity& estimate) const {
  const Terrain seen = options_.seen ? options_.seen(ground) : ground;
  std::string why = "the machine stalls in each dig that is planned";
  for (int harder = 0; harder <= most_attempts; ++harder) {
    const double density = std::min(100.0, estimate.percent + harder * estimate.sd_percent);
    const DigPlan plan = plan_dig(machine_, soil_, density, seen, options_.plan);
    if (!plan.dig) {
      why = plan.reason;
      continue;
    }
    DigScene scene = dug(ground, plan.dig->parameters, plan.dig->start_x);
    if (!scene.dig.stall) return scene;
  }
  throw Error(ErrorKind::bad_input, why);
}

RowTotal DigRow::planned(int digs, const RelativeDensity& first, RelativeDensity& last) const {
  RowTotal total;
  Terrain ground = ground_;
  last = first;
  while (total.digs < digs) {
    const DigScene scene = dug_as_planned(ground, last);
    add(scene, total);
    last = options_.survey(scene);
    ground = without_heap(scene);
  }
  return total;
}

}  // namespace excavplan
