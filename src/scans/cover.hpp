// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/ground/registration.hpp>

/// @file
/// Whether the surface that was seen is that of the soil (docs/methods.md#cover).

namespace excavplan {

/// Looks for what covers the soil or hides it; each ends trust.
///
/// `hole_in_shadow`: of a scan whose sensor's place is unknown, over 1 % more of the hole's cells
/// lie between points after the dig than before, by over three standard deviations (ours).
///
/// `grass`: returns scatter in height less on dug and dumped soil than they did before there: their
/// variance is below 0.75 of that in both together, and below 0.9 in each (ours), by what the
/// ground that did not change shows: it was covered, and by no more than sqrt(3) times the excess
/// of the standard deviation, the mean of returns spread evenly from the ground up.
///
/// `flat_water`: the lowest part of the hole is level to within the noise of its cells, where the
/// ground before was rougher by three times. Where that was as even nothing can be told:
/// state_water().
///
/// @param pairs  the surfaces of each area of the change; without variances nothing is found
std::vector<Warning> check_cover(const std::vector<const SurfacePair*>& pairs,
                                 const VolumeChange& change);

/// States as a reading, not counted, that a floor which is level to within the noise and takes up
/// 20 % of the hole is water, where the ground before was as even: over 5 to 60 % of the depth of
/// the hole, within two standard deviations, with a weight of 0.03 (all ours).
///
/// @param pairs  likewise
void state_water(const std::vector<const SurfacePair*>& pairs, VolumeChange& change);

}  // namespace excavplan
