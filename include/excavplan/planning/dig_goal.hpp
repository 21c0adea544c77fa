// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/planning/planned_dig.hpp>

namespace excavplan {

/// The objective that a search of digs maximises.
struct DigObjective {
  /// What is maximised.
  enum class Goal {
    mass_per_energy,  ///< the paper's f [kg/J]
    mass_per_time,    ///< [kg/s]
    priced,           ///< mass / (energy + time_price * time) [kg/J]
  };
  Goal goal = Goal::mass_per_energy;  ///< what is maximised
  double time_price = 0.0;            ///< what a second is worth, if priced [W], >= 0
  double rest_of_cycle = 0.0;  ///< time of swing, dump and return, added to the dig's [s], >= 0

  double worth(const PlannedDig& dig) const;  ///< larger is better; 0 for a dig that costs nothing
};

/// A goal with its name, its unit and its formula. A new goal is one more value of
/// DigObjective::Goal and one more row of dig_goals().
struct DigGoalInfo {
  DigObjective::Goal goal = DigObjective::Goal::mass_per_energy;  ///< that the row is of
  std::string word;                                               ///< on the command line: "energy"
  std::string description;                                        ///< "mass per energy"
  std::string unit;     ///< in which its worth is shown: "kg/kJ"
  double per_si = 1.0;  ///< the worth in that unit over the worth in SI
  double (*worth)(const DigObjective& objective, const PlannedDig& dig) = nullptr;  ///< SI
  double DigObjective::*parameter = nullptr;  ///< that follows the word after a colon, if any
  std::string parameter_name = {};            ///< "WATT"
};

/// One row per goal, in the order of DigObjective::Goal.
const std::vector<DigGoalInfo>& dig_goals();
const DigGoalInfo& info_of(DigObjective::Goal goal);

}  // namespace excavplan
