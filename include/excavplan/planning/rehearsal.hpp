// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/plan_dig.hpp>

namespace excavplan {

/// Where a plan is dug once more, for the ground that it leaves and its loads.
struct PlanSite {
  const SoilKind& soil;            ///< that is dug
  double density_percent = 0.0;    ///< relative density of it, 0 .. 100
  const Terrain& ground;           ///< before the dig
  const SimulatorKind& simulator;  ///< that digs
};

/// The planned dig, simulated with its history. @param plan  with a dig
/// @throws Error as make_simulator() and dig()
DigResult rehearse(const Machine& machine, const DigPlan& plan, const PlanSite& site);

}  // namespace excavplan
