// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/dig_cycle.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/planning/uncertain_soil.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// From the density of the ground to the joint trajectory of the next dig, in one call.

namespace excavplan {

/// Source of the dig.
enum class PlanMethod {
  library,  ///< looked up; dug once where the ground or the simulator is not the library's
  search,   ///< searched by digs in the simulator, by default from the library's dig on
};
/// "library" or "search".
const char* name(PlanMethod method);

/// The library that excavplan ships for a machine in a soil and a goal; `data_folder` as in
/// find_data_file().
/// @throws Error (bad_input) if none is shipped or it does not fit, (bad_file) if it cannot be read
PathLibrary shipped_library(const Machine& machine, const SoilKind& soil,
                            const DigObjective& objective = dig_goals().front().goal,
                            const std::string& data_folder = data_folder_of_package);

/// How plan_dig() plans.
struct PlanOptions {
  PlanMethod method = PlanMethod::library;  ///< where the dig comes from
  /// Null: shipped_library() of the objective of `search`, read again by every call.
  std::shared_ptr<const PathLibrary> library = nullptr;
  std::string data_folder = data_folder_of_package;  ///< as find_data_file() takes it
  /// `progress` reports and cancels, the seed fixes the result for any number of `threads`, and
  /// `start_rule` also places a dig looked up for given ground. A dig is looked up, and a search
  /// without `start` begins, in the library of `objective`; the paper's algorithm begins at random
  /// unless `start` or `library` is given. Where `stop.evaluations` is 0 the default method makes
  /// evaluation_budget() digs; without any stop rule, with a start that is searched and in the
  /// default simulator it is screened, unless the method has numbers of its own
  /// (docs/methods.md#planning).
  DigSearchOptions search = budget_search();
  SimulatorKind simulator = default_simulator();  ///< digs what is searched or not on level ground
  TrajectoryOptions trajectory = {};              ///< how fast the machine moves
  /// Of the level ground, if none is given; nothing: usual_cell() [m].
  std::optional<double> cell_size = {};
  /// How the machine stands: enters torques, tipping and the forces of the soil. The terrain is
  /// then in the frame of the machine (Machine::attitude), and no figure of a library holds.
  Attitude attitude = {};
  /// Ground that the machine stands on, for standing_ground(): standing_ground_from_scan(). Without
  /// it the terrain is judged as far as it goes.
  std::optional<HeightMap> standing_on = {};
};

/// Results of the search.
struct PlanSearch {
  double worth = 0.0;  ///< of the dig, by the objective, in SI; the mean for an uncertain density
  StopReason stopped_by = StopReason::generations;  ///< what ended the search
  int refused = 0;                                  ///< digs that cannot be driven, not simulated
  /// Which numbers are worth 98 % of the best (SearchInsight::seen), in the order of
  /// dig_parameter_table(), the start last if searched.
  std::vector<ParameterRange> ranges;
  /// What knowing an uncertain density would add, as a share of the worth >= 0; nothing for a
  /// density taken as known and for a search that was stopped.
  std::optional<double> value_of_knowing;
  /// DigSearchResult::ranks; of an uncertain density those of the search in all of its soils.
  std::vector<double> ranks = {};
};

/// Details of a look-up.
struct PlanLookUp {
  double slope = 0.0;                ///< of the ground, as far as the library goes [rad]
  std::optional<MidwayError> error;  ///< look_up_error(); nothing on ground unlike the library's
};

/// The next dig, or why there is none.
struct DigPlan {
  /// Expected figures: the library's on level ground in the simulator that it was computed with,
  /// else those of the dig in `simulator`, their means if searched for an uncertain density.
  /// Nothing if no dig can be done, or if the search was cancelled before it found one.
  std::optional<PlannedDig> dig;
  DigSpread spread;  ///< from the density's standard deviation; zero if that is 0
  DigPath path;      ///< of the dig, with its approach
  std::optional<DigCycle>
      cycle;              ///< of the dig; nothing if the machine does not state what it needs
  Trajectory trajectory;  ///< of that path
  std::vector<JointAngles> torques;  ///< DigResult::torques of that path [N m]
  HeightMap ground_after;            ///< surface after it, at rest [m]; NaN where it did not change
  PlanMethod method = PlanMethod::library;  ///< where the dig comes from
  std::string start_rule;                   ///< rule of the start, human-readable
  int evaluations = 0;                      ///< digs simulated for the plan
  std::optional<PlanSearch> search;         ///< if searched
  std::optional<PlanLookUp> look_up;        ///< if looked up

  Attitude attitude;  ///< of PlanOptions
  Attitude on_slope;  ///< likewise, turned by the slope of the ground about the tracks

  bool stopped = false;     ///< the search was cancelled; the dig is the best until then
  bool trustworthy = true;  ///< false after a warning marked * below
  /// Terrain::doubts, density_as_fraction *, density_not_trustworthy *, law_of_other_soil *,
  /// library_unreadable (the search began with nothing), simulator_failed (at some digs of the
  /// search, which were left out), min_fill_relaxed (no dig was found that fills the bucket as
  /// asked), those of standing_ground() *, obstacle_in_strip (something stands there, which the dig
  /// keeps clear of), slope_outside_library *, ground_unlike_library *, may_stall *,
  /// approach_blocked (the trajectory begins on the ground).
  std::vector<Warning> warnings;

  /// Why there is no dig: none can be done, or none is worth making, with a payload of at least a
  /// tenth of the heaped capacity (ours). Empty if there is one or the search stopped.
  std::string reason;
  std::optional<NearestDig> nearest;  ///< if a search found no dig: what came nearest to one
};

/// Plans the next dig on the ground given, or on level ground.
///
/// What the site decides is in the plan: no feasible dig, a density that the library lacks, a path
/// that does not suit the ground.
///
/// @throws Error (bad_input) as require_machine() and require_soil(); if the layers of the terrain
///         differ in size, the density or an option is out of range, a library given does not
///         fit machine and soil or lacks the density of a search, or none is shipped for them and
///         the method is `library`
/// @throws Error (bad_file) if the shipped library cannot be read and the method is `library`, or a
///         checkpoint of the search is of another one, truncated or altered
DigPlan plan_dig(const Machine& machine, const SoilKind& soil, const GroundDensity& density,
                 const Terrain& terrain, const PlanOptions& options = {});
/// The same on level ground.
DigPlan plan_dig(const Machine& machine, const SoilKind& soil, const GroundDensity& density,
                 const PlanOptions& options = {});

}  // namespace excavplan
