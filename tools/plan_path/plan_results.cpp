// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_results.hpp"

#include <algorithm>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "frame/arguments.hpp"
#include "inputs/goal_inputs.hpp"
#include "results/results.hpp"
#include "results/stated_density.hpp"

namespace excavplan::tools {
namespace {

nlohmann::ordered_json search_json(const PlanSearch& search, const DigGoalInfo& goal) {
  nlohmann::ordered_json json = {{"stopped_by", name(search.stopped_by)},
                                 {"refused", search.refused},
                                 {"worth", goal.per_si * search.worth},
                                 {"worth_unit", goal.unit}};
  const auto& table = dig_parameter_table();
  for (std::size_t i = 0; i < table.size() && i < search.ranges.size(); ++i) {
    json["ranges_98_percent"][table[i].name] = {search.ranges[i].low, search.ranges[i].high};
  }
  return json;
}

nlohmann::ordered_json expectation_json(const PlanSearch& search, const DigGoalInfo& goal) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (goal.goal == DigObjective::Goal::energy)
    json["expected_efficiency_kg_per_kj"] = goal.per_si * search.worth;
  if (search.value_of_knowing) json["value_of_knowing_percent"] = 100.0 * *search.value_of_knowing;
  return json;
}

/// Energy and time of each part.
nlohmann::ordered_json parts_json(const DigCycle& cycle) {
  auto json = nlohmann::ordered_json::object();
  const auto add = [&](const char* part, const CycleShare& share) {
    json[part] = {{"energy_kj", share.energy / 1000.0}, {"time_s", share.time}};
  };
  add("dig", cycle.dig);
  add("lift", cycle.lift);
  add("swing", cycle.swing);
  add("dump", cycle.dump);
  add("back", cycle.back);
  add("lower", cycle.lower);
  add("rest", cycle.rest);
  return json;
}

nlohmann::ordered_json look_up_json(const PlanLookUp& look_up) {
  nlohmann::ordered_json json = {{"look_up_slope_rad", look_up.slope},
                                 {"look_up_loss", nullptr},
                                 {"look_up_expectation_error", nullptr}};
  if (look_up.error) {
    json["look_up_loss"] = look_up.error->loss;
    json["look_up_expectation_error"] = look_up.error->expectation;
  }
  return json;
}

nlohmann::ordered_json spread_json(const DigSpread& spread, double density_sd) {
  return {{"density_sd_percent", density_sd},
          {"payload_mass_sd_kg", spread.payload_mass},
          {"energy_sd_kj", spread.energy / 1000.0},
          {"efficiency_sd_kg_per_kj", 1000.0 * spread.efficiency},
          {"stall_probability", spread.stall_probability}};
}

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

std::string reason_of(const DigPlan& plan) {
  return plan.reason + (plan.nearest ? "; the nearest, " + describe(*plan.nearest) : "");
}

std::string source_line(const DigPlan& plan) {
  const std::string digs =
      plan.evaluations > 0 ? ", " + std::to_string(plan.evaluations) + " digs simulated" : "";
  return "source       " + std::string(name(plan.method)) + digs + "; start: " + plan.start_rule;
}

/// Of a plan for the density of a file.
std::vector<Warning> source_warnings(const DigPlan& plan, const std::string& file,
                                     bool scanned_ground) {
  const StatedDensity stated = stated_density(file);
  std::vector<Warning> warnings;
  if (scanned_ground && plan.dig) {
    const double x = plan.dig->start_x;
    if (const auto far = elsewhere(stated, file, {x, 0.0, x, 0.0})) warnings.push_back(*far);
  }
  if (stated.of_any_soil) {
    warnings.push_back({"density_of_unknown_soil",
                        file + ": the soil was not known: its density is the mean over all shipped "
                               "soils, the dig is planned in one of them"});
  }
  return warnings;
}

}  // namespace

void declare_density(Arguments& arguments, DensityInput& input) {
  arguments.option("density", input.percent, Quantity::percent,
                   "relative density of the ground; this or --density-from is needed");
  arguments.option(
      "density-sd", input.sd, Quantity::percent,
      "standard deviation of the density, propagated to the results; --search then finds the "
      "path with the best expected goal value");
  arguments.file(
      "density-from", input.file,
      "take the density and its uncertainty from this result of estimate-density --json");
  arguments.exclude("density", {"density-from"});
}

void check(const DensityInput& input) {
  if (input.sd && !(*input.sd >= 0.0 && *input.sd <= most_density_sd)) {
    usage_error("--density-sd: " + number_text(*input.sd) + " % is outside 0 .. " +
                number_text(most_density_sd));
  }
  if (!input.percent && !input.file) {
    usage_error("give either --density or --density-from");
  }
  if (input.percent && !(*input.percent >= 0.0 && *input.percent <= 100.0)) {
    usage_error("--density: " + number_text(*input.percent) + " % is outside 0 .. 100");
  }
}

GroundDensity density_of(const DensityInput& input) {
  GroundDensity density =
      input.percent ? GroundDensity(*input.percent) : stated_density(*input.file).density;
  density.sd_percent = input.sd.value_or(density.sd_percent);
  return density;
}

std::vector<Warning> plan_warnings(const DigPlan& plan, const DensityInput& input,
                                   bool scanned_ground) {
  std::vector<Warning> warnings = plan.warnings;
  if (input.file) {
    for (Warning& each : source_warnings(plan, *input.file, scanned_ground)) {
      warnings.push_back(std::move(each));
    }
  }
  if (!plan.reason.empty()) warnings.push_back({"no_dig", reason_of(plan)});
  for (Warning& warning : warnings) {
    const bool of_density =
        warning.code == "density_not_trustworthy" || warning.code == "law_of_other_soil";
    if (of_density && input.file) warning.message = *input.file + ": " + warning.message;
  }
  return warnings;
}

nlohmann::ordered_json plan_json(const DigPlan& plan, const GroundDensity& density,
                                 const DigObjective& objective) {
  nlohmann::ordered_json json = {{"density_percent", density.percent}};
  json.update(goal_json(objective));
  if (!plan.dig) {
    json.update({{"source", name(plan.method)}, {"path", nullptr}});
    if (!plan.reason.empty()) json["reason"] = reason_of(plan);
    return json;
  }
  json.update(dig_json(*plan.dig));
  if (plan.cycle) json["cycle"]["by_part"] = parts_json(*plan.cycle);
  json["source"] = name(plan.method);
  json["start_rule"] = plan.start_rule;
  json["evaluations"] = plan.evaluations;
  const DigGoalInfo& goal = info_of(objective.goal);
  const bool uncertain = density.sd_percent > 0.0;
  if (plan.search) json.update(search_json(*plan.search, goal));
  if (plan.search && uncertain) json.update(expectation_json(*plan.search, goal));
  if (plan.look_up) json.update(look_up_json(*plan.look_up));
  if (uncertain) json.update(spread_json(plan.spread, density.sd_percent));
  return json;
}

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
