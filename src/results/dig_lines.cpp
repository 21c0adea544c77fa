// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/dig_lines.hpp"

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"

namespace excavplan {

std::string path_text(const PlannedDig& dig) {
  return excavplan::path_text(dig.parameters, dig.start_x);
}

std::string worth_text(const DigObjective& objective, double worth) {
  const DigGoalInfo& goal = info_of(objective.goal);
  return readable(goal.per_si * worth) + " " + goal.unit;
}

std::vector<std::string> dig_lines(const PlannedDig& dig, const DigSpread& spread) {
  const double mass = dig.payload_mass;
  const auto of_cycle = [&](double value, const std::string& unit) {
    return " " + unit +
           (dig.cycle_time > 0.0 ? ", of the cycle " + readable(value) + " " + unit : "");
  };
  return {"path         " + path_text(dig),
          "payload      " + readable(mass, spread.payload_mass) + " kg, " +
              readable(dig.payload_volume) + " m3 loose, " + readable(100.0 * dig.fill) +
              " % of the heaped capacity",
          "energy       " + readable(dig.energy / 1000.0, spread.energy / 1000.0) +
              of_cycle(dig.cycle_energy / 1000.0, "kJ"),
          "efficiency   " + readable(1000.0 * dig.efficiency(), 1000.0 * spread.efficiency) +
              of_cycle(1000.0 * mass / dig.cycle_energy, "kg/kJ"),
          "duration     " + readable(dig.duration) + of_cycle(dig.cycle_time, "s"),
          "rate         " + readable(3.6 * mass / dig.duration) +
              of_cycle(3.6 * mass / dig.cycle_time, "t/h")};
}

}  // namespace excavplan
