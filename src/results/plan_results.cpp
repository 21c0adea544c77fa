// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/plan_results.hpp"

#include <variant>

#include "base/json.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

Json search_json(const PlanSearch& search, const DigGoalInfo& goal) {
  Json json = {{"stopped_by", name(search.stopped_by)},
               {"refused", search.refused},
               {"worth", goal.per_si * search.worth},
               {"worth_unit", goal.unit}};
  const auto& table = dig_parameter_table();
  for (std::size_t i = 0; i < table.size() && i < search.ranges.size(); ++i) {
    json["ranges_98_percent"][table[i].name] = {search.ranges[i].low, search.ranges[i].high};
  }
  return json;
}

Json expectation_json(const PlanSearch& search, const DigGoalInfo& goal) {
  Json json = Json::object();
  if (goal.goal == DigObjective::Goal::energy)
    json["expected_efficiency_kg_per_kj"] = goal.per_si * search.worth;
  if (search.value_of_knowing) json["value_of_knowing_percent"] = 100.0 * *search.value_of_knowing;
  return json;
}

/// Energy and time of each part.
Json parts_json(const DigCycle& cycle) {
  auto json = Json::object();
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

Json look_up_json(const PlanLookUp& look_up) {
  Json json = {{"look_up_slope_rad", look_up.slope},
               {"look_up_loss", nullptr},
               {"look_up_expectation_error", nullptr}};
  if (look_up.error) {
    json["look_up_loss"] = look_up.error->loss;
    json["look_up_expectation_error"] = look_up.error->expectation;
  }
  return json;
}

Json spread_json(const DigSpread& spread, double density_sd) {
  return {{"density_sd_percent", density_sd},
          {"payload_mass_sd_kg", spread.payload_mass},
          {"energy_sd_kj", spread.energy / 1000.0},
          {"efficiency_sd_kg_per_kj", 1000.0 * spread.efficiency},
          {"stall_probability", spread.stall_probability}};
}

}  // namespace

std::string reason_of(const DigPlan& plan) {
  return plan.reason + (plan.nearest ? "; the nearest, " + describe(*plan.nearest) : "");
}

Json plan_json(const DigPlan& plan, const GroundDensity& density, const DigObjective& objective) {
  Json json = {{"density_percent", density.percent}};
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
  if (const Attitude& stands = plan.attitude; !stands.is_level()) {
    json["attitude"] = {{"roll_rad", stands.roll}, {"pitch_rad", stands.pitch}};
  }
  json["evaluations"] = plan.evaluations;
  const DigGoalInfo& goal = info_of(objective.goal);
  const bool uncertain = density.sd_percent > 0.0;
  if (plan.search) json.update(search_json(*plan.search, goal));
  if (plan.search && uncertain) json.update(expectation_json(*plan.search, goal));
  if (plan.look_up) json.update(look_up_json(*plan.look_up));
  if (uncertain) json.update(spread_json(plan.spread, density.sd_percent));
  return json;
}

Json search_settings_json(const Machine& machine, const DigSearchOptions& options) {
  Json json = {{"method", "default"}};
  if (const auto* paper = std::get_if<GeneticAlgorithm>(&options.method)) {
    json = {{"method", "paper"},
            {"population", paper->population},
            {"generations", paper->generations},
            {"crossover", paper->crossover},
            {"mutation", paper->mutation},
            {"tournament", paper->tournament},
            {"elites", paper->elites}};
  }
  json["seed"] = options.seed;
  const DigBounds bounds = machine_bounds(machine, options.bounds);
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json["ranges"][info.name] = {bounds.lower.*info.field, bounds.upper.*info.field};
  }
  return json;
}

}  // namespace excavplan
