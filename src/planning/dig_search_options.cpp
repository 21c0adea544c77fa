// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search_options.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace excavplan {
namespace {

/// Of the bucket's length from pin to tip, and angles: ours.
constexpr DigParameters narrowest = {0.1, 0.04, 0.0};
constexpr DigParameters widest = {1.5, 1.2, 3.5};

}  // namespace

DigBounds::DigBounds() {
  for (const DigParameterInfo& info : dig_parameter_table()) {
    lower.*info.field = upper.*info.field = std::numeric_limits<double>::quiet_NaN();
  }
}

DigBounds machine_bounds(const Machine& machine, const DigBounds& bounds) {
  DigBounds filled = bounds;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double unit = info.unit == std::string("m") ? machine.bucket_length : 1.0;
    double& lower = filled.lower.*info.field;
    double& upper = filled.upper.*info.field;
    if (std::isnan(lower)) lower = unit * narrowest.*info.field;
    if (std::isnan(upper)) upper = unit * widest.*info.field;
  }
  return filled;
}

DigSearchOptions budget_search() {
  DigSearchOptions options;
  options.objective = dig_goals().front().goal;
  options.start_rule = StartRule::Kind::searched;
  std::get<MemeticSearch>(options.method).generations = 20;  // the budget ends it long before
  return options;
}

int evaluation_budget(bool uncertain, bool from_known) {
  if (!uncertain) return 600;
  return from_known ? 100 : 200;
}

}  // namespace excavplan
