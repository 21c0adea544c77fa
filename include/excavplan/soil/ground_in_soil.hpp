// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// The state with void ratios in all cells: where the bank's are not known those of this density,
/// where the loose layer's are not known void_ratio_loose. So the state says what was dug.
/// @throws Error (bad_input) as bank_state()
GroundState with_void_ratios(GroundState state, const SoilKind& soil, double density_percent);

}  // namespace excavplan
