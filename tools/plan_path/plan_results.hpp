// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/planning/plan_dig.hpp>

#include "frame/arguments.hpp"
#include "inputs/plots.hpp"
#include "frame/tool.hpp"

/// @file
/// A plan as JSON and as text lines, and the density it is made for from an estimate's JSON.

namespace excavplan::tools {

/// A density from the command line: a number, or a result of estimate-density --json.
struct DensityInput {
  std::optional<double> percent;
  std::optional<double> sd;  ///< [points]; overrides that of the file
  std::optional<std::string> file;
};

void declare_density(Arguments& arguments, DensityInput& input);
/// Checks made before the file is read. @throws Error (bad_input)
void check(const DensityInput& input);
/// @throws Error (bad_file) naming file, key, value and rule
GroundDensity density_of(const DensityInput& input);

/// Those of the plan; where they are about a density from a file they name it. On scanned ground
/// also density_from_elsewhere: the dig begins more than 5 m (ours) from the hole that the density
/// was measured in.
std::vector<Warning> plan_warnings(const DigPlan& plan, const DensityInput& input,
                                   bool scanned_ground);

/// All keys of plan-path but the time it took; "path" is null if there is no dig.
/// @param objective  that the dig was searched for
nlohmann::ordered_json plan_json(const DigPlan& plan, const GroundDensity& density,
                                 const DigObjective& objective);

std::vector<std::string> plan_lines(const DigPlan& plan, const GroundDensity& density,
                                    const std::string& soil, const DigObjective& objective);

}  // namespace excavplan::tools
