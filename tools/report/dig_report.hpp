// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/sensing/scene.hpp>

#include "report/report.hpp"

/// @file
/// The pages about digs, without file, title and plot.

namespace excavplan::tools {

/// A simulated dig. @param scene  with the history of its dig
Report scene_report(const Machine& machine, const DigScene& scene);

/// In which a plan is dug once more for the page, for the ground that it leaves and its loads.
struct PlanSite {
  const SoilKind& soil;
  double density_percent = 0.0;
  const Terrain& ground;
  const SimulatorKind& simulator;
};

/// The planned dig, simulated with its history. @param plan  with a dig
DigResult rehearse(const Machine& machine, const DigPlan& plan, const PlanSite& site);

/// A plan. @param dig  by rehearse(); without one, only the ground
Report plan_report(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                   const std::optional<DigResult>& dig);

}  // namespace excavplan::tools
