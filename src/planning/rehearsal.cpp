// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/rehearsal.hpp>

#include "simulation/checked_dig.hpp"

namespace excavplan {

DigResult rehearse(const Machine& machine, const DigPlan& plan, const PlanSite& site) {
  const Machine standing = with_attitude(machine, plan.attitude);
  const auto simulator = make_simulator(site.simulator, standing, site.soil, site.density_percent);
  DigOptions options;
  options.history = true;
  return checked_dig(*simulator, standing, site.ground, plan.path, options);
}

}  // namespace excavplan
