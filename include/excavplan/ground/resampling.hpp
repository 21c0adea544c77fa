// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>

/// @file
/// Height maps on another grid, and what of the ground no scan saw.

namespace excavplan {

/// A surface on another grid, bilinear between its cells. Gaps that known ground surrounds and that
/// are no wider than `widest_gap` [m] along x or y are filled first, by a membrane through their
/// rims; wider gaps and what lies outside the survey stay NaN.
///
/// @throws Error (bad_input) as flat_ground()
HeightMap resampled(const HeightMap& map, const Rectangle& extent, double cell_size,
                    double widest_gap);

/// Area of the unknown cells that have known ones before and behind them along x [m^2].
double unseen_area(const HeightMap& map);

}  // namespace excavplan
