// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/land_units.hpp"

#include <array>
#include <optional>

#include "base/text.hpp"

namespace excavplan {
namespace {

struct Unit {
  std::string_view system;
  std::string_view name;
  double length;  ///< [m]
};
constexpr std::array<Unit, 10> units = {{{"Metric", "millimeter", 0.001},
                                         {"Metric", "centimeter", 0.01},
                                         {"Metric", "meter", 1.0},
                                         {"Metric", "kilometer", 1000.0},
                                         {"Imperial", "foot", 0.3048},
                                         {"Imperial", "USSurveyFoot", 1200.0 / 3937.0},
                                         {"Imperial", "inch", 0.0254},
                                         {"Imperial", "mile", 1609.344},
                                         {"Imperial", "feet", 0.3048},
                                         {"Imperial", "miles", 1609.344}}};

std::optional<double> length_of(std::string_view system, std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.system == system && unit.name == name) return unit.length;
  }
  return std::nullopt;
}

}  // namespace

LandUnits land_units(const std::string& system, std::string_view linear, std::string_view height) {
  LandUnits found;
  const auto length = length_of(system, linear);
  if (!length) {
    found.fault = "found the linearUnit " + in_quotes(linear) + " of " + system +
                  (system == "Metric" ? ", expected millimeter, centimeter, meter or kilometer"
                                      : ", expected foot, USSurveyFoot, inch or mile");
    return found;
  }
  found.linear = found.height = *length;
  found.told_by = "Units: " + std::string(linear);
  // The schema's default, which programs write whatever foot they mean.
  if (height.empty() || height == "feet") return found;
  const auto up = length_of(system, height);
  if (!up) {
    found.fault = "found the elevationUnit " + in_quotes(height) + ", which is none of " + system;
    return found;
  }
  found.height = *up;
  if (found.height != found.linear) found.told_by += ", heights: " + std::string(height);
  return found;
}

}  // namespace excavplan
