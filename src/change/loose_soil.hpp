// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/change/known_ground.hpp>
#include <excavplan/ground/height_map.hpp>

#include "change/surveyed_area.hpp"

/// @file
/// Loose soil of a ground that is known, and the cut in it. Private to the project.

namespace excavplan {

/// @throws Error (bad_input) unless each layer is empty or as large as the map
void require_known_ground(const KnownGround& known, const HeightMap& before);

/// 1 where loose soil lies within two cells: a step there is of an earlier dig.
Eigen::ArrayXXi dug_before(const KnownGround& known);

/// Sets ZoneSum::loose of each zone that fell, and whether the cut is told.
void find_loose_soil(const KnownGround& known, Area& area);

/// Makes `before` the bank that was cut and `after` its volume since, with the error of the loose
/// soil, and states the cut. What rose less what fell stays.
///
/// With d the fall of a cell and l its loose soil, the hole took min(d, l) of that, and d - l of
/// the bank. Where the bucket cut c of the bank it took all of l, and what lies above its floor has
/// fallen back: l + c - d.
void take_loose_soil(const KnownGround& known, const Area& area, VolumeChange& change);

}  // namespace excavplan
