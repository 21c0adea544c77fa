// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/optimisation/search_settings.hpp>
#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/planning/start_rule.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// Between which digs, in which soils and for which goal a search chooses.

namespace excavplan {

/// One of the soils that the ground may be.
struct PossibleSoil {
  const SoilSimulator* simulator = nullptr;  ///< digs in that soil; not null
  double probability = 0.0;                  ///< > 0; all of them add up to 1
};

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

/// Digs of one search that is not screened; what they reach: docs/methods.md#planning. 600; for
/// each soil that uncertain ground may be, and for all together, 100 from a known good dig on and
/// 200 from nothing. Ours.
int evaluation_budget(bool uncertain, bool from_known);

}  // namespace excavplan
