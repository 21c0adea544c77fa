// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/data_sheet_file.hpp>

#include <cmath>
#include <vector>

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
