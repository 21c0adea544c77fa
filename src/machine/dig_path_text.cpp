// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/dig_path_text.hpp"

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr const char* start_key = "start_x_m";
constexpr double longest_path = 100.0;  // of any machine [m]; ours

std::pair<DigParameters, double> read_numbers(JsonObject& path) {
  DigParameters parameters;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const bool angle = info.unit == std::string("rad");
    parameters.*info.field = path.number(info.name, 0.0, angle ? 0.5 * pi : longest_path);
  }
  return {parameters, path.number(start_key, -longest_path, longest_path)};
}

}  // namespace

nlohmann::ordered_json path_json(const DigParameters& parameters, double start_x) {
  auto json = nlohmann::ordered_json::object();
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json[info.name] = parameters.*info.field;
  }
  json[start_key] = start_x;
  return json;
}

std::pair<DigParameters, double> read_path(JsonObject path) {
  auto read = read_numbers(path);
  path.done();
  return read;
}

std::pair<DigParameters, double> read_planned_path(const std::string& file) {
  JsonObject plan = JsonObject::result_of("plan-path", file);
  if (plan.has("path") && !plan.states("path")) plan.fail("path", "is null, this plan has no dig");
  JsonObject path = plan.object("path");
  return read_numbers(path);
}

std::string path_text(const DigParameters& parameters, std::optional<double> start_x) {
  std::string text;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const bool angle = std::string(info.unit) == "rad";
    const double value = parameters.*info.field;
    text += (text.empty() ? "" : ", ") +
            (angle ? readable(value * 180.0 / pi) + " deg" : readable(value) + ' ' + info.unit);
  }
  return text + (start_x ? " from x = " + readable(*start_x) + " m" : "");
}

}  // namespace excavplan
