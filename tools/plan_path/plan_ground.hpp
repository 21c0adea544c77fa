// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/planning/rehearsal.hpp>

#include "inputs/ground.hpp"
#include "inputs/site.hpp"
#include "plan_path/density_input.hpp"

/// @file
/// The ground that a plan is made for, and its density.

namespace excavplan::tools {

struct PlanGroundInputs {
  DensityInput density;
  TerrainInput terrain;
  GroundInput state;
  std::optional<double> cell_size;

  bool is_level() const { return terrain.is_level() && !state.file; }
};

void declare_plan_ground(Arguments& arguments, PlanGroundInputs& inputs);

struct PlanGround {
  Terrain terrain;                   ///< to dig on
  GroundDensity density;             ///< of its bank; that of --ground where its file tells it
  DensityInput density_from;         ///< where that is from
  std::optional<GivenGround> given;  ///< by --ground
  std::vector<Warning> warnings;
};
/// @throws Error as make_site(), density_of() and given_ground()
PlanGround plan_ground(const PlanGroundInputs& inputs, const Machine& machine,
                       const SoilKind& soil);

/// A plan and where it is dug.
struct PlannedOn {
  const Machine& machine;
  const DigPlan& plan;
  const PlanSite& site;
};
/// Writes --ground-out, if it is asked for: the ground after the dig in the simulator. Warns
/// (map_not_written) if there is no dig.
void write_ground_after(const PlanGroundInputs& inputs, const PlanGround& ground,
                        const PlannedOn& planned, Outcome& outcome);

}  // namespace excavplan::tools
