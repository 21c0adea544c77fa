// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/change/dig_volumes.hpp>

#include "change/attribution.hpp"

namespace excavplan {

/// Enters what is open into the result, whose volumes are known: list, covariance, readings,
/// warnings (attribution_open, stirred_ground).
///
/// The covariance is the second moment of the combinations about the one that is given. The 2.5 %
/// of the weight whose bulking factor is farthest off are left out of it, as they are of an
/// interval of 95 %.
void state_open_changes(const std::vector<Area>& areas, const Attribution& attribution,
                        VolumeChange& result);

}  // namespace excavplan
