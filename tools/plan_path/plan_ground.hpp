// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <excavplan/planning/rehearsal.hpp>

#include "inputs/ground.hpp"
#include "inputs/site.hpp"
#include "plan_path/density_input.hpp"
#include "plan_path/motion_inputs.hpp"
#include "plan_path/plan_site.hpp"

/// @file
/// The ground that a plan is made for, and its density.

namespace excavplan::tools {

struct PlanGroundInputs {
  DensityInput density;
  TerrainInput terrain;
  GroundInput state;
  SiteFolderInputs site;
  std::optional<double> cell_size;

  bool is_level() const { return terrain.is_level() && !state.file && !site.folder; }
};

void declare_plan_ground(Arguments& arguments, PlanGroundInputs& inputs);

struct PlanGround {
  Terrain terrain;                   ///< to dig on; of --site by plan_on()
  GroundDensity density{0.0};        ///< of its bank, likewise; of --ground where its file tells it
  DensityInput density_from;         ///< where that is from
  std::optional<GivenGround> given;  ///< by --ground
  std::shared_ptr<const SiteToPlanOn> site = {};  ///< by --site; else null
  std::optional<GroundDensity> stated = {};       ///< by an option, for a site without digs
  std::vector<Warning> warnings;

  bool is_known = false;  ///< else it is taken to be level

  /// Null unless it is known.
  const Terrain* known() const { return is_known ? &terrain : nullptr; }
};

/// Checks made before the work. @throws Error (bad_input)
void check(const PlanGroundInputs& inputs);
/// @throws Error as make_site(), density_of() and given_ground()
PlanGround plan_ground(const MotionInputs& motion, const PlanGroundInputs& inputs,
                       const Machine& machine, const SoilKind& soil);

/// As plan_on_site() on a site, of which ground and density are then known.
DigPlan plan_on(PlanGround& ground, const Machine& machine, const SoilKind& soil,
                const PlanOptions& options);

/// Ground that the motion must be clear of, and sets that on which the machine stands.
/// @throws Error as motion_ground()
MotionGround ground_to_move_on(const MotionInputs& motion, const PlanGroundInputs& inputs,
                               const PlanGround& ground, const Machine& machine,
                               PlanOptions& options);

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
