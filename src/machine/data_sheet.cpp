// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/data_sheet.hpp>

#include <cmath>

#include "base/files.hpp"
#include "base/text.hpp"
#include "machine/data_sheet_keys.hpp"

namespace excavplan {
namespace {

constexpr double gravity = 9.80665;  // [m/s^2]

/// Figures that grow together.
struct RatioRule {
  const char* key;
  double ratio;
  const char* of;
  double lowest, highest;
  const char* hint;
};

/// Ours: the shipped machines lie inside by a factor of 2; feet, pounds and litres do not.
std::vector<RatioRule> ratio_rules(const DataSheet& sheet) {
  const double mass = *sheet.operating_mass, reach = *sheet.ground_reach;
  std::vector<RatioRule> rules = {
      {"operating_mass_kg", mass / std::pow(reach, 3), "kg per cubed ground_reach_m", 6.0, 150.0,
       "is one of them in t, lb, mm or ft?"},
      {"bucket_capacity_m3", 1000.0 * *sheet.bucket_capacity / mass,
       "litres per kg of operating_mass_kg", 0.008, 0.2, "is it in litres or yd3?"},
      {"depth_m", *sheet.depth / reach, "of ground_reach_m", 0.3, 1.2, "is one of them in ft?"}};
  const auto add = [&](const char* key, const std::optional<double>& figure, double measure,
                       const char* of, double lowest, double highest, const char* hint) {
    if (figure) rules.push_back({key, *figure / measure, of, lowest, highest, hint});
  };
  add("height_m", sheet.height, reach, "of ground_reach_m", 0.4, 2.0, "is one of them in ft?");
  add("bucket_force_n", sheet.bucket_force, gravity * mass, "of the weight", 0.2, 3.0,
      "is it in kN, kgf or lbf?");
  add("arm_force_n", sheet.arm_force, gravity * mass, "of the weight", 0.1, 2.0,
      "is it in kN, kgf or lbf?");
  add("engine_power_w", sheet.engine_power, mass, "W per kg of operating_mass_kg", 1.5, 25.0,
      "is it in kW or hp?");
  return rules;
}

void require_together(const JsonObject& file, const DataSheet& sheet) {
  for (const RatioRule& rule : ratio_rules(sheet)) {
    if (rule.ratio >= rule.lowest && rule.ratio <= rule.highest) continue;
    file.fail(rule.key, "is " + readable(rule.ratio) + " " + rule.of + ", must be in " +
                            number_text(rule.lowest) + " .. " + number_text(rule.highest) + ": " +
                            rule.hint);
  }
  if (sheet.dump_height && sheet.height && *sheet.dump_height >= *sheet.height) {
    file.fail("dump_height_m", "is " + number_text(*sheet.dump_height) +
                                   ", must be below height_m = " + number_text(*sheet.height));
  }
}

void require_complete(const std::string& path, const JsonObject& file) {
  std::string missing = file.has("name") ? "" : "name";
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (each.required && !file.states(each.key)) {
      missing += (missing.empty() ? "" : ", ") + std::string(each.key);
    }
  }
  if (missing.empty()) return;
  throw Error(ErrorKind::bad_file,
              path + ": these keys are missing: " + missing + "; the others are optional");
}

double stated(JsonObject& file, const DataSheetKey& key) {
  const double value = file.number(key.key);
  if (value >= key.lowest && value <= key.highest) return value;
  file.fail(key.key, "is " + number_text(value) + ", must be in " + number_text(key.lowest) +
                         " .. " + number_text(key.highest) + ": " + key.hint);
}

}  // namespace

const std::array<DataSheetKey, 13>& data_sheet_keys() {
  constexpr const char* metres = "is it in m?";
  constexpr const char* newtons = "is it in N, not kN?";
  static const std::array<DataSheetKey, 13> keys = {
      {{"operating_mass_kg", &DataSheet::operating_mass, 300.0, 4e5, "is it in kg, not t?", true},
       {"bucket_capacity_m3", &DataSheet::bucket_capacity, 3e-3, 25.0, "is it in m3, not litres?",
        true},
       {"ground_reach_m", &DataSheet::ground_reach, 1.5, 40.0, metres, true},
       {"depth_m", &DataSheet::depth, 0.7, 30.0, metres, true},
       {"bucket_force_n", &DataSheet::bucket_force, 1.5e3, 2e6, newtons},
       {"arm_force_n", &DataSheet::arm_force, 1e3, 2e6, newtons},
       {"height_m", &DataSheet::height, 1.0, 40.0, metres},
       {"dump_height_m", &DataSheet::dump_height, 0.5, 30.0, metres},
       {"bucket_width_m", &DataSheet::bucket_width, 0.1, 6.0, metres},
       {"engine_power_w", &DataSheet::engine_power, 1.5e3, 2e6, "is it in W, not kW?"},
       {"swing_rate_rad_per_s", &DataSheet::swing_rate, 0.2, 3.0, "is it in rad/s, not rpm?"},
       {"track_gauge_m", &DataSheet::track_gauge, 0.4, 8.0, metres},
       {"track_length_m", &DataSheet::track_length, 0.7, 12.0, metres}}};
  return keys;
}

DataSheet read_data_sheet(JsonObject file) {
  DataSheet sheet;
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (file.has(each.key)) sheet.*each.figure = file.number(each.key, 1e-3, 1e8);
  }
  file.ignore("sources");
  file.done();
  return sheet;
}

nlohmann::json data_sheet_json(const DataSheet& sheet) {
  nlohmann::json json;
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (const auto figure = sheet.*each.figure) json[each.key] = *figure;
  }
  return json;
}

NamedDataSheet load_data_sheet(const std::string& path) {
  JsonObject file = JsonObject::of_plain(path, read_file(path));
  require_complete(path, file);
  NamedDataSheet read;
  read.name = file.text("name");
  for (const DataSheetKey& each : data_sheet_keys()) {
    if (file.has(each.key)) read.sheet.*each.figure = stated(file, each);
  }
  for (const char* free : {"sources", "description"}) file.ignore(free);
  file.done();
  require_together(file, read.sheet);
  return read;
}

}  // namespace excavplan
