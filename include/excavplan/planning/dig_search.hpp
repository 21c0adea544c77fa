// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/optimisation/search_analysis.hpp>
#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/planning/planned_dig.hpp>

/// @file
/// Search for the best dig in a soil: the path of the highest worth, by default of the highest
/// efficiency f = payload mass / energy.

namespace excavplan {

/// Between which digs a search chooses.
struct DigBounds {
  DigParameters lower;  ///< smallest value of each; NaN: of the machine
  DigParameters upper;  ///< largest value of each; NaN: of the machine
  /// All are of the machine.
  DigBounds();
};

/// The ranges of a machine's digs: in proportion to its bucket, from pin to tip, and wider than any
/// best dig known (docs/methods.md#planning). @return the bounds, with what was NaN filled in
DigBounds machine_bounds(const Machine& machine, const DigBounds& bounds = {});

/// A dig that a search may begin with.
struct KnownDig {
  DigParameters parameters;            ///< of its path
  std::optional<double> start_x = {};  ///< where starts are searched; none: that of least work [m]

  /// Not explicit: most known digs are numbers alone.
  // NOLINTNEXTLINE(google-explicit-constructor)
  KnownDig(const DigParameters& numbers, std::optional<double> x = {})
      : parameters(numbers), start_x(x) {}
};

/// An evaluation is a dig, its fitness the rank of the dig's worth.
struct DigSearchOptions : SearchSettings {
  std::vector<KnownDig> start = {};                    ///< known good digs to begin with
  DigObjective objective = {};                         ///< by default most mass per energy
  DigBounds bounds = {};                               ///< of the numbers of the path
  StartRule start_rule = StartRule::Kind::least_work;  ///< where digs begin
  DigPathOptions rules = {};                           ///< that paths must keep
};

/// Settings of plan_dig(): most mass per energy of the cycle, and as many generations as a budget
/// of evaluations allows.
DigSearchOptions budget_search();

/// Digs of one search; what they reach: docs/methods.md#planning. 600; for each soil that uncertain
/// ground may be, and for all together, 100 from a known good dig on and 200 from nothing. Ours.
int evaluation_budget(bool uncertain, bool from_known);

/// The best dig found.
struct DigSearchResult {
  PlannedDig dig;                                   ///< the best one
  DigPath path;                                     ///< of the dig, without an approach
  double worth = 0.0;                               ///< of the dig, by the objective
  int evaluations = 0;                              ///< digs simulated
  int refused = 0;                                  ///< digs that cannot be driven, not simulated
  int infeasible = 0;                               ///< of the evaluations: the machine stalled
  int failed = 0;                                   ///< of the evaluations: the simulator failed
  std::string first_failure = {};                   ///< the reason of the first that failed
  bool stopped = false;                             ///< by `progress`
  StopReason stopped_by = StopReason::generations;  ///< what ended the search
  /// Numbers of the path that lie at an end of their range, where a wider one may hold a better
  /// dig. Not those at 0.
  std::vector<const DigParameterInfo*> at_bound = {};
  SearchInsight insight;  ///< in the order of dig_parameter_table(), the start last if searched
  /// DigObjective::rank() of each dig simulated, in the order asked; NaN: it stalled or failed.
  std::vector<double> ranks = {};
};

/// The dig that a search came nearest to a feasible one with.
struct NearestDig {
  DigParameters parameters;       ///< of its path
  std::optional<double> start_x;  ///< [m]; nothing if no start was found for it
  /// The share of the path that is left where the machine stalls, 0 .. 1; above 1 for a path that
  /// cannot be driven, more the earlier it fails.
  double violation = 0.0;
  std::string reason;  ///< human-readable
};
/// "45.0 deg, 0.350 m, 1.50 m from x = 6.05 m: why it cannot be done"
std::string describe(const NearestDig& nearest);

/// The result of a search; empty if no dig was feasible.
template <typename Result>
struct Found : std::optional<Result> {
  using std::optional<Result>::optional;
  std::optional<NearestDig> nearest;  ///< if empty; nothing if it was stopped before the first dig
  bool stopped = false;               ///< if empty: by `progress`
  int evaluations = 0;                ///< if empty: digs simulated, of a search in one soil
};

/// Searches the numbers of a dig for the highest worth. All checks of the path come before the
/// simulation: what cannot be driven costs no evaluation. Its violation, how much of the path is
/// left where it fails, leads the search back to digs that can be driven.
///
/// A dig that the simulator fails at, or answers with a result that no dig can have
/// (SoilSimulator), is an evaluation that failed: it is counted and the search goes on.
///
/// @throws Error (bad_input) if an argument or an option is out of range, the machine does not
/// state
///         what the goal needs, or the first 20 digs all failed (the first reason is quoted)
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered; another
///         simulator is known by its identity()
Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options = {});

}  // namespace excavplan
