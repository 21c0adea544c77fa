// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/error.hpp>
#include <excavplan/ground/volume_change.hpp>

/// @file
/// Whether the surface that was seen is that of the soil (docs/methods.md#cover).

namespace excavplan {

/// Looks for what covers the soil; both end trust.
///
/// `grass`: returns scatter in height less on dug and on dumped soil than they did before there, by
/// what the ground that did not change shows: it was covered, and by no more than sqrt(3) times the
/// excess of the standard deviation, the mean of returns spread evenly from the ground up.
///
/// `flat_water`: the lowest part of the hole is level to within the noise of its cells, where the
/// ground before was rougher by three times. Where that was as even nothing can be told.
///
/// @param pairs  the surfaces of each area of the change; without variances nothing is found
std::vector<Warning> check_cover(const std::vector<const SurfacePair*>& pairs,
                                 const VolumeChange& change);

}  // namespace excavplan
