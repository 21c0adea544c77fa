// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <excavplan/planning/dig_goal.hpp>

#include "base/json.hpp"

/// @file
/// Planned digs as JSON, their goals, and the interpolation between two of them. Private to the
/// project.

namespace excavplan {

/// All that is expected of a dig, but not what is done.
inline constexpr double PlannedDig::*dig_figures[] = {
    &PlannedDig::payload_mass, &PlannedDig::payload_volume, &PlannedDig::energy,
    &PlannedDig::duration,     &PlannedDig::fill,           &PlannedDig::cycle_energy,
    &PlannedDig::cycle_time};

nlohmann::ordered_json dig_json(const PlannedDig& dig);
/// Of the keys that dig_json() writes. @throws Error (bad_file)
PlannedDig read_dig(JsonObject& object);

/// "goal" and "goal_parameters", those that matter to it.
nlohmann::ordered_json goal_json(const DigObjective& objective);
/// Of these keys. @throws Error (bad_file)
DigObjective read_goal(JsonObject& object);

/// Every number as it is, in SI, for texts between processes and files of a run.
void to_json(nlohmann::json& json, const DigParameters& parameters);
void from_json(const nlohmann::json& json, DigParameters& parameters);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedDig, parameters, start_x, payload_mass, payload_volume,
                                   energy, duration, fill, cycle_energy, cycle_time)

/// True if the two digs differ so much that they may be of different kinds, and a mix of them
/// neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b);

/// The value at a place by the polynomial of the logarithm through known places and their values,
/// which are > 0: worths of best digs vary so, almost linearly, over density and slope.
double log_polynomial(const std::vector<std::pair<double, double>>& known, double place);

/// At a share of the way from one dig to another.
PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share,
                       Between between = Between::mix);

}  // namespace excavplan
