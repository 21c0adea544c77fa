// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_lines.hpp"

#include "base/text.hpp"
#include "results/dig_lines.hpp"

namespace excavplan::tools {
namespace {

std::string expected_line(const PlanSearch& search, const DigObjective& objective,
                          double density_sd) {
  std::string line = "expected     " + worth_text(objective, search.worth) +
                     " at a standard deviation of " + readable(density_sd) + " points of density";
  if (!search.value_of_knowing) return line;
  return line + "; value of knowing the density: " + readable(100.0 * *search.value_of_knowing, 2) +
         " %";
}

/// Empty where the dig is that of an entry on level ground.
std::string look_up_line(const PlanLookUp& look_up) {
  if (!look_up.error || (look_up.error->loss == 0.0 && look_up.slope == 0.0)) return "";
  std::string line = "looked up    ";
  if (look_up.slope != 0.0) line += "on a slope of " + readable(look_up.slope, 2) + " rad";
  if (look_up.error->loss == 0.0) return line;
  return line + (look_up.slope != 0.0 ? ", " : "") + "between entries, up to " +
         readable(100.0 * look_up.error->loss, 2) + " % below the best";
}

std::string source_line(const DigPlan& plan) {
  const std::string digs =
      plan.evaluations > 0 ? ", " + std::to_string(plan.evaluations) + " digs simulated" : "";
  return "source       " + std::string(name(plan.method)) + digs + "; start: " + plan.start_rule;
}

}  // namespace

std::vector<std::string> plan_lines(const DigPlan& plan, const GroundDensity& density,
                                    const std::string& soil, const DigObjective& objective) {
  if (!plan.dig) {
    return {plan.stopped ? "stopped before any dig was found" : "path         none"};
  }
  std::vector<std::string> lines = {
      "density      " + readable(density.percent, density.sd_percent) + " % in " + soil,
      "goal         " + info_of(objective.goal).description + ", " +
          worth_text(objective, plan.search ? plan.search->worth : objective.worth(*plan.dig))};
  for (const std::string& line : dig_lines(*plan.dig, plan.spread)) lines.push_back(line);
  if (plan.search && density.sd_percent > 0.0) {
    lines.push_back(expected_line(*plan.search, objective, density.sd_percent));
  }
  if (plan.look_up && !look_up_line(*plan.look_up).empty()) {
    lines.push_back(look_up_line(*plan.look_up));
  }
  if (plan.spread.stall_probability > 0.0) {
    lines.push_back("stalls       with a probability of " +
                    readable(100.0 * plan.spread.stall_probability, 2) + " %");
  }
  lines.push_back(source_line(plan));
  return lines;
}

}  // namespace excavplan::tools
