// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/job/job_settings.hpp>
#include <excavplan/planning/planned_dig.hpp>

#include "job/dump_place.hpp"
#include "job/job_learning.hpp"
#include "job/job_stations.hpp"
#include "job/lane_view.hpp"

/// @file
/// The dig from one place that gains most of the design for its cost. Private to the project.

namespace excavplan {

/// What a machine may dig from where it stands.
struct StepTask {
  const JobSettings& settings;
  const JobMap& map;
  const Terrain& ground;
  BasePose base;  ///< with the height that its edge keeps in truth
  DumpPlace dump;
  const std::vector<DigStart>& barren;  ///< digs that lifted hardly any, or were blocked
  std::vector<WorkLine> lines = {};     ///< to dig along
  bool may_risk = false;                ///< a stall, as no dig of the job stalled yet
  bool may_bite = true;                 ///< less than a bucket, where no more can be had
  double slack = 0.0;  ///< so far below the design ground does not count as too deep [m]
  /// A layer of a wide design is dug off before what is below this height of the site [m].
  std::optional<double> bench = {};
  bool has_others_beside = false;  ///< soil that leaves its lane for another one is no loss
  bool finishing = false;          ///< along the floor, for its shape
  bool has_faces = false;          ///< some of the design is neither floor nor wall
  bool has_steps = false;          ///< faces are cut in steps by lanes along them
  double tracks = 0.0;             ///< JobFrame::tracks [rad]
  bool leaves_floor = false;       ///< of passes all but those
  bool keeps_load = false;         ///< a load that the bucket can keep is not dumped
  double carried = 0.0;            ///< loose, in the bucket [m^3]
  double allowance = 0.0;          ///< over the design, below which nothing is cut [m]
  double density_percent = 50.0;   ///< of the bank, as believed
  double strength_factor = 1.0;    ///< on the soil's strength, as believed
  double hard_factor = 1.0;        ///< likewise, at which no dig may stall
  double deepest_cut = 0.5;        ///< of one dig below the ground [m]
};

/// A dig, with what it does to the shape of the ground.
struct StepDig {
  double turned = 0.0;  ///< WorkLine [rad]
  double lane = 0.0;    ///< likewise [m]
  DigPath path;         ///< in the frame of the line, with its approach
  PlannedDig dig;       ///< with its cycle
  ShapeChange change;
  DigSigns signs;
  bool may_stall = false;  ///< if the soil is as strong as StepTask::hard_factor
  double worth = 0.0;      ///< volume of the design per cost of the cycle [m^3/J]
};

/// @return nothing if no dig gains anything
std::optional<StepDig> best_dig(const StepTask& task);

/// Whether soil stays in the bucket where the dig begins.
bool can_hold_load(const SoilKind& soil, const DigPath& path);

/// The same place, from a line so far to the left of the machine's view [rad].
DumpPlace seen_from(DumpPlace dump, double turned);

/// What follows a dig: back to the next one with the load, or over the dump.
/// @param carried  before it [kg]
CycleOptions cycle_after(const DumpPlace& dump, bool keeps_load, double carried = 0.0);

}  // namespace excavplan
