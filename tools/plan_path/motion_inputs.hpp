// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/planning/cycle_motion.hpp>
#include <excavplan/planning/plan_dig.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"
#include "inputs/site.hpp"

/// @file
/// The motion of a planned dig: what it begins and ends with, and the file that it is written to.

namespace excavplan::tools {

struct MotionInputs {
  std::optional<std::string> file;  ///< "-": standard output
  std::string format = "ending";
  std::optional<std::string> joints;  ///< ours in their order, or by name those of the robot
  bool whole_cycle = false;
  std::optional<std::string> surroundings;  ///< as the terrain, in frame and unit of the terrain's
  MotionOptions options;
};

void declare_motion(Arguments& arguments, MotionInputs& inputs);

/// Ground that a motion must be clear of, and where its machine stands.
struct MotionGround {
  Terrain ground;
  std::vector<Warning> warnings = {};                    ///< of the scans together
  const char* known_by = "level, clear ground assumed";  ///< for people
  /// Of the machine in the frame of the cloud.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// Ground that the motion must be clear of, where it leaves the dig: that of `terrain`, and what it
/// does not see of --surroundings, with warnings of both together. Checks all of the inputs before
/// the work. @throws Error as make_site(), or (bad_input) naming the option
MotionGround motion_ground(const MotionInputs& inputs, const Machine& machine,
                           const TerrainInput& terrain, const CycleOptions& cycle);

/// The ground to dig on: make_site() over planning_extent(), with what stood on it by
/// --surroundings unless it has gone. @throws Error as make_site()
Site dig_site(const MotionInputs& inputs, const Machine& machine, const TerrainInput& terrain,
              double cell_size);

/// How the machine stands, and with --terrain on what: PlanOptions::attitude and standing_on, which
/// is of both clouds as well.
void set_standing(const MotionInputs& inputs, const Machine& machine, const TerrainInput& terrain,
                  PlanOptions& options);

/// A plan with the ground on which the machine stands and the objective that has its swing and dump
/// height.
struct PlannedMotion {
  const Machine& machine;
  const MotionGround& ground;  ///< motion_ground(): the dig's ground is a strip of it
  const DigPlan& plan;
  const DigObjective& objective;
};

/// That of the dig alone, for pages: the points of a file without present joints or whole cycle.
Trajectory dig_motion(const MotionInputs& inputs, const Machine& machine, const DigPlan& plan);

/// Writes the motion, if it is asked for; one without points if there is no dig, or the ground is
/// in the way (warning no_motion), so that none of an earlier plan is driven. Sets keys "ground"
/// and "trajectory" of the outcome and adds the motion's warnings. @throws Error (bad_input) naming
/// the option
void write_motion(const MotionInputs& inputs, const PlannedMotion& planned, Outcome& outcome);

}  // namespace excavplan::tools
