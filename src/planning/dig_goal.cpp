// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_goal.hpp>

#include <algorithm>

namespace excavplan {
namespace {

double over(double mass, double cost) { return cost > 0.0 ? mass / cost : 0.0; }

double cycle_time(const DigObjective& objective, const PlannedDig& dig) {
  return dig.duration + objective.rest_of_cycle;
}

double mass_per_energy(const DigObjective&, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.energy);
}

double mass_per_time(const DigObjective& objective, const PlannedDig& dig) {
  return over(dig.payload_mass, cycle_time(objective, dig));
}

double priced(const DigObjective& objective, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.energy + objective.time_price * cycle_time(objective, dig));
}

}  // namespace

const std::vector<DigGoalInfo>& dig_goals() {
  using Goal = DigObjective::Goal;
  static const std::vector<DigGoalInfo> goals = {
      {Goal::mass_per_energy, "energy", "mass per energy", "kg/kJ", 1000.0, mass_per_energy},
      {Goal::mass_per_time, "time", "mass per time", "kg/s", 1.0, mass_per_time},
      {Goal::priced, "priced", "mass per energy, with a price per second", "kg/kJ", 1000.0, priced,
       &DigObjective::time_price, "WATT"},
  };
  return goals;
}

const DigGoalInfo& info_of(DigObjective::Goal goal) {
  return *std::find_if(dig_goals().begin(), dig_goals().end(),
                       [&](const DigGoalInfo& info) { return info.goal == goal; });
}

double DigObjective::worth(const PlannedDig& dig) const { return info_of(goal).worth(*this, dig); }

}  // namespace excavplan
