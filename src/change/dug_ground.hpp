// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/change/known_ground.hpp>
#include <excavplan/ground/height_map.hpp>

#include "change/change_zones.hpp"

/// @file
/// Where known ground was dug: before, and now along the path of the bucket. Private to the
/// project.

namespace excavplan {

/// 1 where loose soil lies within two cells: a step there is of an earlier dig.
Eigen::ArrayXXi dug_before(const KnownGround& known);

/// Change that a dig along a known path is taken to have made at most where no scan shows it: where
/// the bucket did not cut the bank, it took loose soil alone [m]. Empty where no cut is told.
Eigen::ArrayXXd lowest_change(const KnownGround& known);

/// Fills ground under the path of the bucket that the scan after does not show: it lies above the
/// floor that was swept by what lies on it where it is seen, by the median of at least 20 cells, or
/// else by a fifth of the cut. Its cells join the largest zone that fell there; without one, or
/// without a cut that is told, nothing is filled. All numbers are ours.
///
/// @param lowest  lowest_change()
/// @param after  NaN where unknown
/// @return variance of the sum of the filled heights, by zone [m^2]: all err alike, by the
///         deviation of what lies on the floor
std::vector<double> fill_swept(const KnownGround& known, const Eigen::ArrayXXd& lowest,
                               const HeightMap& before, HeightMap& after, ChangedGround& ground);

}  // namespace excavplan
