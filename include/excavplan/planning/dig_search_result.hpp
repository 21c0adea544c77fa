// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/optimisation/search_analysis.hpp>
#include <excavplan/planning/dig_outcome.hpp>

/// @file
/// What a search for a dig found, or what it came nearest to.

namespace excavplan {

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
  /// Of search_screened() the first are those in coarser steps.
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

}  // namespace excavplan
