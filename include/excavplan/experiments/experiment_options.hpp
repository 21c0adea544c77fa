// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Where the second dig is made.
enum class SecondGround {
  fresh,  ///< on ground as it was before the first
  left    ///< on the ground that the first left, with its heap beside
};

/// What is dug and planned with; by default for most mass per energy, as in the paper.
struct ExperimentOptions {
  DigParameters fixed_path = paper_fixed_path();  ///< of every first dig
  PlanOptions plan = {};                          ///< of the second dig; `cell_size` holds for both
  /// That makes both digs; empty: that of `plan`, which only plans otherwise.
  std::optional<SimulatorKind> digs = {};
  std::optional<SoilKind> dug_soil = {};      ///< that lies there, if not the kind planned for
  std::optional<Terrain> ground = {};         ///< of scene_extent(); empty: level ground
  SecondGround second = SecondGround::fresh;  ///< where the second dig is made
  /// The density that a survey of the first dig gives; empty: the law on its height maps, which
  /// have no error.
  std::function<RelativeDensity(const DigScene& first)> survey = {};
  std::optional<RelativeDensity> estimate = {};  ///< known before: the first dig is not surveyed
  std::optional<double> planned_density = {};    ///< planned for; empty: as estimated [%]
  /// The ground as the plan sees it; empty: as it is.
  std::function<Terrain(const Terrain& ground)> seen = {};

  ExperimentOptions() { plan.search.objective = DigObjective::Goal::energy; }
};

}  // namespace excavplan
