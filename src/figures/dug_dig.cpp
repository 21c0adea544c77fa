// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/dug_dig.hpp"

#include "base/text.hpp"

namespace excavplan {

std::string scene_title(const DigScene& scene) {
  return "Dig in " + scene.soil + " at " + readable(scene.density_percent) + " % relative density";
}

std::string plan_title(const DigPlan& plan, const PlanSite& site) {
  return (plan.dig ? "Planned dig in " : "No dig in ") + site.soil.name + " at " +
         readable(site.density_percent) + " % relative density";
}

}  // namespace excavplan
