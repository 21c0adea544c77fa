// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/dig_report.hpp"

#include "base/text.hpp"

namespace excavplan::tools {

Report scene_report(const Machine& machine, const DigScene& scene) {
  Report report;
  report.headline = {"payload_mass_kg", "energy_kj",     "efficiency_kg_per_kj",
                     "duration_s",      "peak_force_kn", "bulking_factor"};
  report.scene.areas = {{{{"before", scene.before.surface()}, {"after", scene.after.surface()}}}};
  report.scene.machine = machine;
  report.scene.digs = {played_dig("dig", machine, scene.path, scene.dig)};
  report.note = "Ground and loads are those of the simulated dig; the heap is its payload, dumped.";
  if (scene.dig.stall) report.fault = "The dig stalled.";
  if (scene.blocks) report.scene.areas.front().states.back() = {"after", scene.blocks->after};
  if (scene.blocks) report.scene.areas.front().states.front() = {"before", scene.blocks->before};
  return report;
}

Report plan_report(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                   const std::optional<DigResult>& dig) {
  Report report;
  report.headline = {"payload_mass_kg", "energy_kj",    "efficiency_kg_per_kj",
                     "cycle.energy_kj", "cycle.time_s", "cycle.rate_t_per_h"};
  report.scene.areas = {{{{"before", site.ground.surface()}}}};
  report.scene.machine = machine;
  if (!dig) {
    report.fault = plan.stopped ? "Stopped before any dig was found." : "There is no dig.";
    return report;
  }
  report.scene.areas.front().states.push_back({"planned", dig->after(site.ground).surface()});
  report.scene.digs = {{"planned dig", plan.path, plan.trajectory, dig->history}};
  report.note = "Planned ground and loads are those of the planned dig, simulated once at " +
                readable(site.density_percent) +
                " % density; the payload stays in the bucket. The figures are those of the plan.";
  return report;
}

}  // namespace excavplan::tools
