// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_site.hpp"

#include <algorithm>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

constexpr double usual_depth = 0.5;  // ours: of a cut of the zx120 [m]

}  // namespace

SiteToPlanOn::SiteToPlanOn(const SiteFolderInputs& inputs, const Machine& machine,
                           const SoilKind& soil)
    : machine_(machine),
      base_(base_of(inputs)),
      site_(*inputs.folder, SiteSettings{soil, machine, {}, {}, {}}) {}

Terrain SiteToPlanOn::ground(const Rectangle& extent, double cell_size) const {
  return site_.ground_for(base_, extent, cell_size).terrain;
}

GroundDensity SiteToPlanOn::density_in_reach() const {
  const Rectangle all = planning_extent(machine_);
  const double half = 0.5 * machine_.bucket.width_outside;
  return site_.density_at(base_, {all.x_min, -half, all.x_max, half},
                          usual_depth * dig_size(machine_));
}

GroundDensity SiteToPlanOn::density_under(const DigPlan& plan) const {
  if (!plan.dig) return density_in_reach();
  const Rectangle strip = swept_strip(machine_, plan.path);
  const double area = (strip.x_max - strip.x_min) * (strip.y_max - strip.y_min);
  const double depth = plan.dig->payload_volume / area;  // loose, as about a heaped bucket spills
  return site_.density_at(base_, strip, std::max(depth, 0.5 * site_.cell_size()));
}

void SiteToPlanOn::describe(const GroundDensity& density, Outcome& outcome) const {
  RelativeDensity shown;
  shown.raw_percent = shown.percent = density.percent;
  set_error(shown, density.sd_percent);
  outcome.json["site"] = site_json(site_, shown);
  outcome.lines.push_back("site         " + std::to_string(site_.updates()) + " scans, " +
                          std::to_string(site_.digs()) + " digs; density where it digs " +
                          readable(density.percent, density.sd_percent) + " %");
}

}  // namespace excavplan::tools
