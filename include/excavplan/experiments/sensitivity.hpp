// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/planning/dig_search.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// How far the best path depends on what neither the paper nor the maker publishes
/// (docs/validation.md#assumptions).

namespace excavplan {

/// All that decides which dig is best on level ground.
struct DigModel {
  Machine machine;                            ///< that digs
  SoilKind soil;                              ///< that is dug
  SimulatorKind simulator;                    ///< how
  DigSearchOptions search = budget_search();  ///< goal, ranges, rules of paths, rule of the start
  double cell_size = 0.05;                    ///< of the ground [m]
};

/// Another number in the place of one that is ours.
struct Assumption {
  std::string factor;                     ///< "floor above the cut"
  std::string level;                      ///< "0 deg"
  std::function<void(DigModel&)> change;  ///< of the reference
};

/// What is ours in machine, soil, path rules and search, one at a time.
std::vector<Assumption> our_assumptions();

/// The best path under one assumption in soil of one density.
struct AssumptionResult {
  std::string factor;                ///< of the assumption; "reference": none is changed
  std::string level;                 ///< of the assumption
  double density_percent = 0.0;      ///< of the soil
  std::optional<PlannedDig> best;    ///< as it is dug under the assumption; nothing: no dig
  double worth = 0.0;                ///< of it there, by the objective
  std::optional<PlannedDig> really;  ///< the same path in the reference; nothing: it cannot be dug
  /// Share of the best worth known in the reference that is lost by digging that path there [%].
  double regret_percent = 0.0;
  std::string failure = {};  ///< why there is no `best` or no `really`
};

/// Settings of run_sensitivity().
struct SensitivityOptions {
  std::vector<double> densities_percent = {10.0, 40.0, 80.0};  ///< of the soil
  int digs = 300;        ///< of one search, which begins with the best dig of the reference; ours
  unsigned threads = 0;  ///< 0: one per core; the result is the same for any number
  /// Called from any thread after each search with the share that is done; true goes on.
  std::function<bool(double done)> progress = {};
};

/// Searches the best dig under each assumption and digs it in the reference, if it cannot be dug
/// from its own start there, from the nearest where it can. For each density first the reference,
/// then the assumptions in order. The best dig known in the reference is the best there of all that
/// were found, so that no regret is below 0. Empty if `progress` ends it.
///
/// @throws Error (bad_input) as plan_dig() of the reference
std::vector<AssumptionResult> run_sensitivity(const DigModel& reference,
                                              const std::vector<Assumption>& assumptions,
                                              const SensitivityOptions& options = {});

}  // namespace excavplan
