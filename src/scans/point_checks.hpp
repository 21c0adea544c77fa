// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/registration.hpp>

/// @file
/// Whether the points of two scans lie as those of ground do, where they count.

namespace excavplan {

/// Code `two_surfaces`: points of hole, spill or heap lie on two surfaces, one above the other.
/// Code `outliers`: points off even ground are so many and so far to one side of it that like ones
/// in hole, spill and heap would count. Where they may change the bulking factor by 1 %; by 3 %, or
/// 2 % of outliers, they end trust. Code `floor_cut`: a limit of heights cut the hole's floor off.
/// @param pairs  of each area of the change; null where its points are not known
std::vector<Warning> check_points(const std::vector<const SurfacePair*>& pairs,
                                  const VolumeChange& change);

}  // namespace excavplan
