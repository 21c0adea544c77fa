// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/planned_dig.hpp>

namespace excavplan {

/// Fill of the bucket below which a dig is not worth making, for plans and libraries; ours.
inline constexpr double worth_making = 0.1;

/// The objective that a search of digs maximises.
struct DigObjective : CycleOptions {
  /// What is maximised.
  enum class Goal {
    cycle,   ///< mass per energy of the whole cycle [kg/J]
    energy,  ///< the paper's f, mass per energy of the dig [kg/J]
    time,    ///< mass per time of the cycle [kg/s]
    priced,  ///< mass / (energy + time_price * time) of the cycle [kg/J]
  };
  Goal goal = Goal::energy;  ///< what is maximised
  double time_price = 0.0;   ///< what a second is worth, if priced [W], >= 0
  /// Least PlannedDig::fill, 0 .. 1; where it cannot be reached, about the most that can.
  double min_fill = 0.0;

  /// With the goal's usual min_fill.
  DigObjective(Goal of = Goal::energy);  // NOLINT: a goal is an objective

  /// The same, with a min_fill of worth_making at least.
  DigObjective worthwhile() const;

  /// Larger is better; 0 for a dig that costs nothing, NaN for one with a figure that is NaN.
  double worth(const PlannedDig& dig) const;
  /// What searches maximise: the worth, and of a dig that fills less than min_fill a half of it and
  /// less, by the tenth power of fill / min_fill; ours.
  double rank(double worth, double fill) const;
  /// Of a dig, by its worth and fill.
  double rank(const PlannedDig& dig) const { return rank(worth(dig), dig.fill); }
};

/// A goal with its name, its unit and its formula. A new goal is one more value of
/// DigObjective::Goal and one more row of dig_goals().
struct DigGoalInfo {
  DigObjective::Goal goal = DigObjective::Goal::energy;  ///< that the row is of
  std::string word;                                      ///< on the command line: "energy"
  std::string description;                               ///< "mass per energy"
  std::string unit;                                      ///< in which its worth is shown: "kg/kJ"
  double per_si = 1.0;  ///< the worth in that unit over the worth in SI
  double (*worth)(const DigObjective& objective, const PlannedDig& dig) = nullptr;  ///< SI
  bool of_cycle = true;                       ///< CycleOptions matter
  double min_fill = 0.0;                      ///< usual
  double DigObjective::*parameter = nullptr;  ///< that follows the word after a colon, if any
  std::string parameter_name = {};            ///< "WATT"
};

/// One row per goal, in the order of DigObjective::Goal; the first is that of plan_dig().
const std::vector<DigGoalInfo>& dig_goals();
const DigGoalInfo& info_of(DigObjective::Goal goal);

/// A number of an objective. Checks, checkpoints, libraries and options follow the table of them.
struct DigObjectiveParameter {
  const char* name;             ///< key in JSON, ends in the unit: "swing_rad"
  const char* unit;             ///< "rad", "m", "s", "W" or "-"
  const char* text;             ///< readable
  const char* option;           ///< on the command line, "swing"; empty: follows the goal's word
  double DigObjective::*field;  ///< where it is kept
  double highest = 1e9;         ///< that it may be
  double lowest = 0.0;          ///< likewise; the cost depends on its size alone

  /// Whether the worth by this goal depends on it.
  bool matters_to(const DigGoalInfo& goal) const;
};
const std::vector<DigObjectiveParameter>& objective_parameters();

/// The goal and the sizes of all parameters that matter to it: "cycle, min_fill 0.8, swing_rad
/// 1.57, ...".
std::string describe(const DigObjective& objective);

/// @throws Error (bad_input) if a parameter breaks its rule, or as require_cycle() if the goal
/// needs
///         the cycle
void check(const DigObjective& objective, const Machine& machine);

}  // namespace excavplan
