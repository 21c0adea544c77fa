// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <excavplan/soil/soil.hpp>

/// @file
/// What loops over cells, drawn soils and files of other kinds need of a soil. Private to the
/// project.

namespace excavplan {

class JsonObject;

/// A soil within a file of another kind, by the keys and rules of a soil file: the numbers of its
/// own law of the cone index alone.
nlohmann::ordered_json soil_json(const SoilKind& soil);
/// @throws Error (bad_file) as load_soil()
SoilKind read_soil(JsonObject object);

/// Of any soil, also a loose one; ours.
constexpr double most_void_ratio = 20.0;
constexpr double most_cohesion = 1e6;       ///< of the loosest state; ours [Pa]
constexpr double steepest_friction = 1.05;  ///< 60 deg; no soil has more [rad]
/// The resistance has terms of cohesion over its tangent; ours [rad].
constexpr double flattest_friction = 0.01;
constexpr double least_cone_index = 1.0;  ///< of a law's reference; ours [Pa]
constexpr double most_cone_index = 1e9;   ///< likewise

/// bank_state_of_void_ratio() of a soil and a void ratio that were checked before.
SoilState checked_bank_state(const SoilKind& soil, double void_ratio);
/// loose_state_of_void_ratio() likewise; out of the range it is that at its end.
SoilState checked_loose_state(const SoilKind& soil, double void_ratio);

}  // namespace excavplan
