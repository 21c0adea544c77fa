// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/planned_digs.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "machine/dig_path_text.hpp"

namespace excavplan {

nlohmann::ordered_json dig_json(const PlannedDig& dig) {
  return {
      {"path", path_json(dig.parameters, dig.start_x)},    {"payload_mass_kg", dig.payload_mass},
      {"payload_volume_m3", dig.payload_volume},           {"energy_kj", dig.energy / 1000.0},
      {"efficiency_kg_per_kj", 1000.0 * dig.efficiency()}, {"duration_s", dig.duration}};
}

PlannedDig read_dig(JsonObject& object) {
  PlannedDig dig;
  std::tie(dig.parameters, dig.start_x) = read_path(object.object("path"));
  dig.payload_mass = object.number("payload_mass_kg", 0.0);
  dig.payload_volume = object.number("payload_volume_m3", 0.0);
  dig.energy = 1000.0 * object.number("energy_kj", 0.0);
  dig.duration = object.number("duration_s", 0.0);
  object.ignore("efficiency_kg_per_kj");
  return dig;
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

PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, bool nearest) {
  if (share == 0.0) return a;
  if (nearest) return share < 0.5 ? a : b;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  PlannedDig dig = a;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    dig.parameters.*info.field = mix(a.parameters.*info.field, b.parameters.*info.field);
  }
  for (double PlannedDig::*figure :
       {&PlannedDig::start_x, &PlannedDig::payload_mass, &PlannedDig::payload_volume,
        &PlannedDig::energy, &PlannedDig::duration}) {
    dig.*figure = mix(a.*figure, b.*figure);
  }
  return dig;
}

}  // namespace excavplan
