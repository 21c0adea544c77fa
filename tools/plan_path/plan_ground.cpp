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

PlanGround ground_of_site(const PlanGroundInputs& inputs, const Machine& machine,
                          const SoilKind& soil) {
  const DensityInput& told = inputs.density;
  const auto site = std::make_shared<SiteToPlanOn>(inputs.site, machine, soil);
  if ((told.percent || told.file || told.sd) && site->has_density()) {
    usage_error(
        "--density, --density-sd and --density-from exclude --site, which has digs that "
        "tell the density");
  }
  PlanGround ground;
  ground.density_from = told;
  if (told.percent || told.file) ground.stated = density_of(told);
  ground.is_known = true;
  ground.site = site;
  return ground;
}

}  // namespace

void declare_plan_ground(Arguments& arguments, PlanGroundInputs& inputs) {
  declare_terrain(arguments, inputs.terrain);
  declare_attitude(arguments, inputs.terrain);
  declare_ground(arguments, inputs.state,
                 {terrain_options({"attitude"}),
                  "the planned dig as it is foretold; the payload is off the ground"});
  declare_site_folder(arguments, inputs.site,
                      "plan on the ground and for the density that estimate-density --site "
                      "remembers in this folder");
  arguments.exclude("site", terrain_options({"ground", "attitude"}));
}

void check(const PlanGroundInputs& inputs) {
  DensityInput density = inputs.density;
  density.by_site = inputs.site.folder.has_value();
  check(density);
}

PlanGround plan_ground(const MotionInputs& motion, const PlanGroundInputs& inputs,
                       const Machine& machine, const SoilKind& soil) {
  if (inputs.site.folder) return ground_of_site(inputs, machine, soil);
  PlanGround ground;
  ground.density = density_of(inputs.density);
  ground.density_from = inputs.density;
  ground.given = given_ground(inputs.state, machine, soil, ground.density.percent);
  ground.is_known = ground.given || inputs.terrain.cloud;
  if (ground.given) {
    ground.terrain = ground.given->terrain;
    take_density_of_file(inputs, ground);
    return ground;
  }
  Site site =
      dig_site(motion, machine, inputs.terrain, inputs.cell_size.value_or(usual_cell(machine)));
  ground.terrain = std::move(site.ground);
  ground.warnings = std::move(site.warnings);
  return ground;
}

DigPlan plan_on(PlanGround& ground, const Machine& machine, const SoilKind& soil,
                const PlanOptions& options) {
  if (ground.site) {
    SitePlan planned = ground.site->plan(options, ground.stated);
    ground.density = planned.density;
    ground.terrain = std::move(planned.ground);
    return std::move(planned.plan);
  }
  return ground.is_known ? plan_dig(machine, soil, ground.density, ground.terrain, options)
                         : plan_dig(machine, soil, ground.density, options);
}

MotionGround ground_to_move_on(const MotionInputs& motion, const PlanGroundInputs& inputs,
                               const PlanGround& ground, const Machine& machine,
                               PlanOptions& options) {
  MotionGround area = motion_ground(motion, machine, inputs.terrain, options.search.objective);
  set_standing(motion, machine, inputs.terrain, options);
  if (ground.given) area = {ground.terrain, {}, "as in the ground file"};
  if (!ground.site) return area;
  const double cell = usual_cell(machine);
  area = {ground.site->ground(swing_extent(machine), cell), {}, "as the site knows it"};
  HeightMap below = ground.site->ground(standing_extent(machine), 2.0 * cell).highest();
  if (!below.z.isNaN().all()) options.standing_on = std::move(below);
  return area;
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
