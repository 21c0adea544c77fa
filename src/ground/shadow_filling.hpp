// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

#include "ground/change_zones.hpp"

namespace excavplan {

/// Fills ground of the scan after that lies in the shadow of what its sensor saw.
///
/// From the rim of a shadow the ground is taken to fall at the slope of the faces that were seen of
/// the same hole, or of the heaps, until it meets the floor of the hole or the ground before; it is
/// nowhere above the lowest ray that passed. The cells of a shadow join the zones whose ground they
/// continue.
///
/// @param before heights [m]
/// @param after heights, NaN where unknown; shadows are filled
/// @param ground its zones are widened
/// @return variance of the sum of the filled heights, by zone [m^2]
std::vector<double> fill_shadows(const HeightMap& before, HeightMap& after,
                                 const Eigen::Vector3d& sensor, ChangedGround& ground);

}  // namespace excavplan
