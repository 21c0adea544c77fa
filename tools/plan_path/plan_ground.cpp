// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_ground.hpp"

#include <utility>

namespace excavplan::tools {
namespace {

/// The density that the file tells is one that nothing is uncertain of.
void take_density_of_file(const PlanGroundInputs& inputs, PlanGround& ground) {
  const auto& told = ground.given->density_percent;
  if (!told) return;
  if (ground.density.sd_percent > 0.0) {
    ground.warnings.emplace_back(WarningCode::options_ignored,
                                 "the standard deviation of the density has no effect: " +
                                     *inputs.state.file + " tells the density of the bank");
  }
  ground.density = GroundDensity(*told);
  ground.density_from = {*told, std::nullopt, std::nullopt};
}

}  // namespace

void declare_plan_ground(Arguments& arguments, PlanGroundInputs& inputs) {
  declare_terrain(arguments, inputs.terrain);
  declare_attitude(arguments, inputs.terrain);
  declare_ground(arguments, inputs.state,
                 {{"terrain", "terrain-frame", "unit", "attitude"},
                  "the planned dig as it is foretold; the payload is off the ground"});
}

PlanGround plan_ground(const PlanGroundInputs& inputs, const Machine& machine,
                       const SoilKind& soil) {
  PlanGround ground = {{}, density_of(inputs.density), inputs.density, std::nullopt, {}};
  ground.given = given_ground(inputs.state, machine, soil, ground.density.percent);
  if (ground.given) {
    ground.terrain = ground.given->terrain;
    take_density_of_file(inputs, ground);
    return ground;
  }
  Site site = make_site(inputs.terrain, planning_extent(machine),
                        inputs.cell_size.value_or(usual_cell(machine)));
  ground.terrain = std::move(site.ground);
  ground.warnings = std::move(site.warnings);
  return ground;
}

void write_ground_after(const PlanGroundInputs& inputs, const PlanGround& ground,
                        const PlannedOn& planned, Outcome& outcome) {
  if (!inputs.state.out) return;
  if (!planned.plan.dig) {
    outcome.warnings.emplace_back(WarningCode::map_not_written,
                                  *inputs.state.out + ": is not written, as there is no dig");
    return;
  }
  const DigResult dig = rehearse(planned.machine, planned.plan, planned.site);
  write_ground(inputs.state, ground.given ? &*ground.given : nullptr, ground.terrain,
               dig.after(ground.terrain), planned.site.soil);
}

}  // namespace excavplan::tools
