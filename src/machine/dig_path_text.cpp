// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/dig_path_text.hpp"

#include <excavplan/error.hpp>

#include "base/angles.hpp"
#include "base/files.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

constexpr const char* start_key = "start_x_m";

}  // namespace

nlohmann::ordered_json path_json(const DigParameters& parameters, double start_x) {
  nlohmann::ordered_json json;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    json[info.name] = parameters.*info.field;
  }
  json[start_key] = start_x;
  return json;
}

constexpr double longest_path = 100.0;  // of any machine [m]; ours

std::pair<DigParameters, double> read_path(JsonObject path) {
  DigParameters parameters;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const bool angle = info.unit == std::string("rad");
    parameters.*info.field = path.number(info.name, 0.0, angle ? 0.5 * pi : longest_path);
  }
  const double start_x = path.number(start_key);
  path.done();
  return {parameters, start_x};
}

std::pair<DigParameters, double> read_planned_path(const std::string& file) {
  const nlohmann::json json = parse_json(file, read_file(file));
  const auto number = [&](const std::string& key) {
    const nlohmann::json::json_pointer place("/path/" + key);
    const bool there = json.is_object() && json.contains(place);
    if (there && json.at(place).is_number()) return json.at(place).get<double>();
    throw Error(ErrorKind::bad_file, file + ": path." + key + " must be a number, it is " +
                                         (there ? shown(json.at(place)) : "missing") +
                                         "; expected a result of plan-path --json");
  };
  DigParameters parameters;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    parameters.*info.field = number(info.name);
  }
  return {parameters, number(start_key)};
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
