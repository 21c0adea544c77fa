// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_site.hpp"

#include "base/text.hpp"

namespace excavplan::tools {

SiteToPlanOn::SiteToPlanOn(const SiteFolderInputs& inputs, const Machine& machine,
                           const SoilKind& soil)
    : base_(base_of(inputs)), site_(*inputs.folder, SiteSettings{soil, machine, {}, {}, {}}) {}

Terrain SiteToPlanOn::ground(const Rectangle& extent, double cell_size) const {
  return site_.ground_for(base_, extent, cell_size).terrain;
}

SitePlan SiteToPlanOn::plan(const PlanOptions& options,
                            const std::optional<GroundDensity>& density) const {
  return plan_on_site(site_, {base_, options, density});
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
