// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/ground_state.hpp>
#include <excavplan/site/site_event.hpp>

/// @file
/// The grid of a site: its lines lie at whole multiples of the cell, whatever its extent, so that
/// it grows without a cell being resampled.

namespace excavplan {

/// The extent to the grid's next lines outside of it, or to the nearest that lie within 1e-6 cells.
Rectangle on_grid(const Rectangle& extent, double cell_size);

/// Ground of this extent, on_grid(), that no scan saw. All layers but the bank's void ratio are
/// there; the loose soil's is `loose_void_ratio`.
/// @throws Error (bad_input) if it has more than most_site_cells
GroundState unseen_ground(const Rectangle& extent, double cell_size, double loose_void_ratio);

/// The ground on the smallest grid that covers it and this extent.
/// @throws Error (bad_input) as unseen_ground()
GroundState grown(const GroundState& ground, const Rectangle& extent, double loose_void_ratio);

/// The ground in the frame of a machine. Heights are bilinear between known cells, all else is that
/// of the nearest one, as heights beside unknown cells are; where the cells of both grids are the
/// same, each keeps its number.
/// @throws Error (bad_input) as flat_ground()
GroundState seen_by(const GroundState& ground, const BasePose& base, const HeightMap& grid);

}  // namespace excavplan
