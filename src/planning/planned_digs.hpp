// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/planned_dig.hpp>

#include "base/json.hpp"

/// @file
/// Planned digs as JSON, and the interpolation between two of them. Private to the project.

namespace excavplan {

nlohmann::ordered_json dig_json(const PlannedDig& dig);
/// Of the keys that dig_json() writes. @throws Error (bad_file)
PlannedDig read_dig(JsonObject& object);

/// Every number as it is, in SI, for texts between processes and files of a run.
void to_json(nlohmann::json& json, const DigParameters& parameters);
void from_json(const nlohmann::json& json, DigParameters& parameters);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedDig, parameters, start_x, payload_mass, payload_volume,
                                   energy, duration)

/// True if the two digs differ so much that they may be of different kinds, and a mix of them
/// neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b);

/// Linear between two digs, or the nearer one.
PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, bool nearest);

}  // namespace excavplan
