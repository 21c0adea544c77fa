// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/ground/height_map.hpp>

#include "change/surveyed_area.hpp"

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

}  // namespace excavplan
