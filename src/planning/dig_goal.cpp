// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_goal.hpp>

#include <algorithm>
#include <cmath>

#include <excavplan/planning/dig_cycle.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr double usual_fill = 0.8;  // of a cycle; ours

double over(double mass, double cost) { return cost > 0.0 ? mass / cost : 0.0; }

double per_cycle_energy(const DigObjective&, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.cycle_energy);
}

double per_energy(const DigObjective&, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.energy);
}

double per_time(const DigObjective&, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.cycle_time);
}

double priced(const DigObjective& objective, const PlannedDig& dig) {
  return over(dig.payload_mass, dig.cycle_energy + objective.time_price * dig.cycle_time);
}

}  // namespace

const std::vector<DigGoalInfo>& dig_goals() {
  using Goal = DigObjective::Goal;
  static const std::vector<DigGoalInfo> goals = {
      {Goal::cycle, "cycle", "mass per energy of the cycle", "kg/kJ", 1000.0, per_cycle_energy,
       true, usual_fill},
      {Goal::energy, "energy", "mass per energy of the dig alone, as in the paper", "kg/kJ", 1000.0,
       per_energy, false},
      {Goal::time, "time", "mass per time of the cycle", "kg/s", 1.0, per_time},
      {Goal::priced, "priced", "mass per energy of the cycle, with a price per second", "kg/kJ",
       1000.0, priced, true, 0.0, &DigObjective::time_price, "WATT"},
  };
  return goals;
}

const DigGoalInfo& info_of(DigObjective::Goal goal) {
  const auto found = std::find_if(dig_goals().begin(), dig_goals().end(),
                                  [&](const DigGoalInfo& info) { return info.goal == goal; });
  if (found == dig_goals().end()) refuse("objective: its goal is none of DigObjective::Goal");
  return *found;
}

const std::vector<DigObjectiveParameter>& objective_parameters() {
  static const std::vector<DigObjectiveParameter> parameters = {
      {"time_price_w", "W", "price of time", "", &DigObjective::time_price},
      {"min_fill", "-", "smallest fill of the bucket, as a fraction of its heaped capacity",
       "min-fill", &DigObjective::min_fill, 1.0},
      {"swing_rad", "rad", "swing from dig to dump (to the right: below 0)", "swing",
       &DigObjective::swing, 2.0 * pi, -2.0 * pi},
      {"dump_height_m", "m", "height of the bucket pin at which it dumps", "dump-height",
       &DigObjective::dump_height},
      {"rest_of_cycle_s", "s", "waiting time of a cycle", "rest-of-cycle",
       &DigObjective::rest_of_cycle},
  };
  return parameters;
}

bool DigObjectiveParameter::matters_to(const DigGoalInfo& goal) const {
  if (field == &DigObjective::min_fill) return true;
  return field == &DigObjective::time_price ? goal.parameter == field : goal.of_cycle;
}

DigObjective::DigObjective(Goal of) : goal(of), min_fill(info_of(of).min_fill) {}

DigObjective DigObjective::worthwhile() const {
  DigObjective objective = *this;
  objective.min_fill = std::max(min_fill, worth_making);
  return objective;
}

double DigObjective::worth(const PlannedDig& dig) const { return info_of(goal).worth(*this, dig); }

double DigObjective::rank(double worth, double fill) const {
  return fill >= min_fill ? worth : 0.5 * worth * std::pow(fill / min_fill, 10);
}

std::string describe(const DigObjective& objective) {
  const DigGoalInfo& goal = info_of(objective.goal);
  std::string text = goal.word;
  for (const DigObjectiveParameter& parameter : objective_parameters()) {
    if (!parameter.matters_to(goal)) continue;
    text += std::string(", ") + parameter.name + " " +
            number_text(std::abs(objective.*parameter.field));
  }
  return text;
}

void check(const DigObjective& objective, const Machine& machine) {
  for (const DigObjectiveParameter& parameter : objective_parameters()) {
    const double value = objective.*parameter.field;
    const std::string unit =
        parameter.unit == std::string("-") ? "" : std::string(" ") + parameter.unit;
    require(value >= parameter.lowest && value <= parameter.highest,
            std::string("the ") + parameter.text, value,
            "in " + number_text(parameter.lowest) + " .. " + number_text(parameter.highest) + unit);
  }
  if (info_of(objective.goal).of_cycle) require_cycle(machine, objective);
}

}  // namespace excavplan
