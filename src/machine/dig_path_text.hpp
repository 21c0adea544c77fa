// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <excavplan/machine/dig_parameters.hpp>

#include "base/json.hpp"

/// @file
/// The path of a dig, its parameters and its start, as JSON and as text. Private to the project.

namespace excavplan {

/// {"penetration_angle_rad": ..., ..., "start_x_m": ...}, the "path" of results and libraries.
nlohmann::ordered_json path_json(const DigParameters& parameters, double start_x);

/// Parameters and start of such an object in a file of ours. @throws Error (bad_file)
std::pair<DigParameters, double> read_path(JsonObject path);

/// The same of a result of plan-path --json.
/// @throws Error (bad_file) naming file, key, value and rule
std::pair<DigParameters, double> read_planned_path(const std::string& file);

/// "45.0 deg, 0.350 m, 1.50 m from x = 6.05 m", the last part where the start is known.
std::string path_text(const DigParameters& parameters, std::optional<double> start_x = {});

}  // namespace excavplan
