// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/planner.hpp>

#include "base/json.hpp"

/// @file
/// Planned digs as JSON, and the interpolation between two of them. Private to the project.

namespace excavplan {

nlohmann::ordered_json dig_json(const PlannedDig& dig);
/// Of the keys that dig_json() writes. @throws Error (bad_file)
PlannedDig read_dig(JsonObject& object);

/// True if the two digs differ so much that they may be of different kinds, and a mix of them
/// neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b);

/// Linear between two digs, or the nearer one.
PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, bool nearest);

}  // namespace excavplan
