// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/ground/plain_ground.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// The state with the void ratios of its densities, e = e_max - d (e_max - e_min). Loose soil is
/// never looser than void_ratio_loose, which its densities near 0 % stand for.
/// @throws Error (bad_input) as require_soil()
GroundState ground_in_soil(const PlainGround& plain, const SoilKind& soil);

/// Reads a ground file of save_ground(), or a JSON as load_plain_ground() does.
/// @throws Error (bad_file) as these, or if the void ratios are of another soil or outside its
/// range
GroundState load_ground(const std::string& file, const SoilKind& soil);

/// The terrain of a state with the void ratios that it does not tell: of the bank, where it tells
/// any, those of this density, of the loose soil void_ratio_loose.
/// @throws Error (bad_input) as bank_state()
Terrain terrain_to_dig(const GroundState& state, const SoilKind& soil, double density_percent);

/// Mean relative density of the bank in the cells whose centres lie in a rectangle; nothing if the
/// terrain tells none there [%]. @throws Error (bad_input) as require_soil()
std::optional<double> bank_density_percent(const Terrain& terrain, const SoilKind& soil,
                                           const Rectangle& where);

}  // namespace excavplan
