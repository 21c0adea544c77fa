// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/planning/plan_dig.hpp>

#include "frame/arguments.hpp"

/// @file
/// The density that a plan is made for, and what is to be said of it.

namespace excavplan::tools {

/// A density from the command line: a number, or a result of estimate-density --json.
struct DensityInput {
  std::optional<double> percent;
  std::optional<double> sd;  ///< [points]; overrides that of the file
  std::optional<std::string> file;
  bool by_site = false;  ///< none is needed: --site knows one
};

void declare_density(Arguments& arguments, DensityInput& input);
/// Checks made before the file is read. @throws Error (bad_input)
void check(const DensityInput& input);
/// @throws Error (bad_file) naming file, key, value and rule
GroundDensity density_of(const DensityInput& input);

/// Those of the plan; where they are about a density from a file they name it. On scanned ground
/// also density_from_elsewhere: the dig begins more than 5 m (ours) from the hole that the density
/// was measured in; and ground_before_dig: the ground does not show that hole.
/// @param scanned  null: no ground was scanned
std::vector<Warning> plan_warnings(const DigPlan& plan, const DensityInput& input,
                                   const Terrain* scanned);

}  // namespace excavplan::tools
