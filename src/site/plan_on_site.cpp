// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/site/plan_on_site.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/soil/ground_in_soil.hpp>

#include "base/check.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr double usual_depth = 0.5;       // ours: of a cut of the zx120 [m]
constexpr double least_difference = 1.0;  // ours: of densities that are planned for [points]

GroundDensity density_in_reach(const Site& site, const BasePose& base) {
  const Machine& machine = site.settings().machine;
  const Rectangle all = planning_extent(machine);
  const double half = 0.5 * machine.bucket.width_outside;
  return site.density_at(base, {all.x_min, -half, all.x_max, half},
                         usual_depth * dig_size(machine));
}

/// Whether any of what a dig may cut is known.
bool shows_ground_ahead(const HeightMap& ground, const Machine& machine) {
  bool is_known = false;
  for_each_cell(ground.z, [&](Cell at) {
    is_known |= std::abs(ground.y(at.row)) < 0.5 * machine.bucket.width_outside &&
                std::isfinite(ground.z(at.row, at.col));
  });
  return is_known;
}

/// Of the strip that a dig cuts.
GroundDensity density_under(const Site& site, const BasePose& base, const DigPlan& plan) {
  const Rectangle strip = swept_strip(site.settings().machine, plan.path);
  const double area = (strip.x_max - strip.x_min) * (strip.y_max - strip.y_min);
  const double depth = plan.dig->payload_volume / area;  // loose, as about a heaped bucket spills
  return site.density_at(base, strip, std::max(depth, 0.5 * site.cell_size()));
}

bool differ(const GroundDensity& a, const GroundDensity& b) {
  return std::abs(a.percent - b.percent) > least_difference ||
         std::abs(a.sd_percent - b.sd_percent) > least_difference;
}

/// Puts what stands on the present ground onto the remembered one, which is not seen below it.
void put_obstacles(const Terrain& present, Terrain& ground) {
  if (present.obstacles.size() == 0) return;
  require(same_grid(present.bank, ground.bank),
          "the present ground must have the cells of the plan");
  const auto stands = !present.obstacles.isNaN();
  ground.obstacles = stands.select(present.obstacles, ground.obstacles).eval();
  ground.bank.z = stands.select(std::numeric_limits<double>::quiet_NaN(), ground.bank.z).eval();
}

}  // namespace

SitePlan plan_on_site(const Site& site, const SitePlanOptions& options) {
  const SiteSettings& of = site.settings();
  SitePlan planned;
  const bool is_told = !site.belief().digs().empty();  // by a dig, if only that it stalled
  const bool is_stated = !is_told && options.density;
  const double cell = options.plan.cell_size.value_or(usual_cell(of.machine));
  GroundState known;
  known.terrain = site.ground_for(options.base, planning_extent(of.machine), cell).terrain;
  if (is_stated)
    planned.density = *options.density;
  else if (shows_ground_ahead(known.terrain.bank, of.machine))
    planned.density = density_in_reach(site, options.base);
  else
    planned.density = {site.belief().settings().mean_percent,
                       site.belief().settings().level_sd_percent};
  if (options.present) put_obstacles(*options.present, known.terrain);
  planned.ground = terrain_to_dig(known, of.soil, planned.density.percent);
  const auto plan = [&] {
    planned.plan = plan_dig(of.machine, of.soil, planned.density, planned.ground, options.plan);
  };
  plan();
  if (!is_told || !planned.plan.dig) return planned;
  const GroundDensity there = density_under(site, options.base, planned.plan);
  if (!differ(there, planned.density)) return planned;
  planned.density = there;
  plan();
  return planned;
}

}  // namespace excavplan
