// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/planned_digs.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <excavplan/planning/goal_words.hpp>

#include "base/text.hpp"
#include "machine/dig_path_text.hpp"

namespace excavplan {

nlohmann::ordered_json dig_json(const PlannedDig& dig) {
  const auto per_hour = [&](double time) { return 3.6 * dig.payload_mass / time; };
  nlohmann::ordered_json json = {{"path", path_json(dig.parameters, dig.start_x)},
                                 {"payload_mass_kg", dig.payload_mass},
                                 {"payload_volume_m3", dig.payload_volume},
                                 {"fill_fraction", dig.fill},
                                 {"energy_kj", dig.energy / 1000.0},
                                 {"efficiency_kg_per_kj", 1000.0 * dig.efficiency()},
                                 {"duration_s", dig.duration},
                                 {"rate_t_per_h", per_hour(dig.duration)}};
  if (dig.cycle_time > 0.0) {
    json["cycle"] = {{"energy_kj", dig.cycle_energy / 1000.0},
                     {"time_s", dig.cycle_time},
                     {"efficiency_kg_per_kj", 1000.0 * dig.payload_mass / dig.cycle_energy},
                     {"rate_t_per_h", per_hour(dig.cycle_time)}};
  }
  return json;
}

namespace {

constexpr double most_energy = 1e12;  // [kJ], ours: far above any dig's

/// Where a figure per energy or time, which the file states too, would be infinite.
void require_per(const JsonObject& object, const std::string& key, double mass, double per) {
  if (std::isfinite(1000.0 * mass / per)) return;
  object.fail(key, "is " + number_text(per) + " in its base unit, too little for a payload of " +
                       number_text(mass) + " kg");
}

}  // namespace

PlannedDig read_dig(JsonObject& object) {
  PlannedDig dig;
  std::tie(dig.parameters, dig.start_x) = read_path(object.object("path"));
  dig.payload_mass = object.number("payload_mass_kg", 0.0);
  dig.payload_volume = object.number("payload_volume_m3", 0.0);
  dig.fill = object.number("fill_fraction", 0.0);
  dig.energy = 1000.0 * object.number("energy_kj", 0.0, most_energy);
  dig.duration = object.number("duration_s", 0.0);
  require_per(object, "duration_s", dig.payload_mass, dig.duration);
  if (dig.energy > 0.0) require_per(object, "energy_kj", dig.payload_mass, dig.energy);
  if (object.has("cycle")) {
    JsonObject cycle = object.object("cycle");
    dig.cycle_energy = 1000.0 * cycle.number("energy_kj", 0.0, most_energy);
    dig.cycle_time = cycle.number("time_s", 0.0);
    if (dig.cycle_time > 0.0) {
      require_per(cycle, "time_s", dig.payload_mass, dig.cycle_time);
      require_per(cycle, "energy_kj", dig.payload_mass, dig.cycle_energy);
    }
    cycle.ignore("efficiency_kg_per_kj");
    cycle.ignore("rate_t_per_h");
    cycle.done();
  }
  object.ignore("efficiency_kg_per_kj");
  object.ignore("rate_t_per_h");
  return dig;
}

nlohmann::ordered_json goal_json(const DigObjective& objective) {
  const DigGoalInfo& goal = info_of(objective.goal);
  nlohmann::ordered_json json = {{"goal", goal.word}};
  for (const DigObjectiveParameter& parameter : objective_parameters()) {
    if (!parameter.matters_to(goal)) continue;
    json["goal_parameters"][parameter.name] = std::abs(objective.*parameter.field);
  }
  return json;
}

DigObjective read_goal(JsonObject& object) {
  const std::string word = object.text("goal");
  const DigGoalInfo* const goal = goal_of_word(word);
  if (!goal) object.fail("goal", "is " + in_quotes(word) + ", which is no goal");
  DigObjective objective(goal->goal);
  JsonObject numbers = object.object("goal_parameters");
  for (const DigObjectiveParameter& parameter : objective_parameters()) {
    if (!parameter.matters_to(*goal)) continue;
    objective.*parameter.field = numbers.number(parameter.name, 0.0, parameter.highest);
  }
  numbers.done();
  return objective;
}

void to_json(nlohmann::json& json, const DigParameters& parameters) {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json[info.name] = parameters.*info.field;
  }
}

void from_json(const nlohmann::json& json, DigParameters& parameters) {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json.at(info.name).get_to(parameters.*info.field);
  }
}

// Two digs that differ by more than this fraction of a number's range may be of different kinds;
// ours.
static constexpr double near = 0.2;

bool far_apart(const PlannedDig& a, const PlannedDig& b) {
  const auto& table = dig_parameter_table();
  return std::any_of(table.begin(), table.end(), [&](const DigParameterInfo& info) {
    const double step = std::abs(a.parameters.*info.field - b.parameters.*info.field);
    return step > near * (info.upper - info.lower);
  });
}

double log_polynomial(const std::vector<std::pair<double, double>>& known, double place) {
  double sum = 0.0;
  for (const auto& [own, value] : known) {
    double weight = std::log(value);
    for (const auto& [other, unused] : known) {
      if (other != own) weight *= (place - other) / (own - other);
    }
    sum += weight;
  }
  return std::exp(sum);
}

PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, Between between) {
  if (share == 0.0) return a;
  if (share == 1.0 || between == Between::upper) return b;
  if (between == Between::lower) return a;
  if (between == Between::nearest) return share < 0.5 ? a : b;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  PlannedDig dig = a;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    dig.parameters.*info.field = mix(a.parameters.*info.field, b.parameters.*info.field);
  }
  dig.start_x = mix(a.start_x, b.start_x);
  for (double PlannedDig::*figure : dig_figures) {
    dig.*figure = mix(a.*figure, b.*figure);
  }
  return dig;
}

}  // namespace excavplan
