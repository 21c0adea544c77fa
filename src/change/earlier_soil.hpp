// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/change/known_ground.hpp>
#include <excavplan/ground/height_map.hpp>

#include "change/surveyed_area.hpp"

/// @file
/// Loose soil of earlier digs: as the scan before shows it, or in ground that is known. Private to
/// the project.

namespace excavplan {

/// States that the hole was dug through loose soil, as an earlier dig leaves it beside its pit:
/// where the scan before shows a hump in the hole, as steep as loose soil lies (19 to 50 degrees),
/// above the plane of the ground around by 5 cm and by three times what that ground deviates. Such
/// soil V is as loose before as after: k = (after - V) / (before - V). It is a reading as likely as
/// not, is in the covariance, and ends trust (`earlier_soil`) where it moves k by more than 3 %.
/// All numbers are ours.
///
/// @param before  heights before of each area, on its grid
/// @param change  with volumes and readings
void state_earlier_soil(const std::vector<const HeightMap*>& before, const std::vector<Area>& areas,
                        VolumeChange& change);

// ---- In ground that is known -------------------------------------------------------------------

/// @throws Error (bad_input) unless each layer is empty or as large as the map
void require_known_ground(const KnownGround& known, const HeightMap& before);

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
