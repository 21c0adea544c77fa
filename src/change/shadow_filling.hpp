// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/surface.hpp>

#include "change/change_zones.hpp"
#include "ground/sensor_place.hpp"

namespace excavplan {

/// Two scans of one area, the one after from known places.
struct ShadowedScans {
  const HeightMap& before;
  HeightMap& after;              ///< NaN where unknown; shadows are filled
  const Eigen::ArrayXXi& mixed;  ///< 1 where drop_mixed_returns() dropped a cell of `after`
  const Surface& places;         ///< where its sensors stood, and what each saw
  /// Set if nothing says where it stood but the scan itself.
  const std::optional<SensorPlace>& inferred;
  const Eigen::ArrayXXd& lowest;  ///< change below which no cell lies [m]; empty: not known
};

/// Fills ground of the scan after that lies in the shadow of what its sensors saw.
///
/// From the rim of a shadow the ground is taken to fall at the slope of the faces that were seen of
/// the same hole, or of the heaps, until it meets the floor of the hole or the ground before; it is
/// nowhere above the lowest ray that passed. The cells of a shadow join the zones whose ground they
/// continue.
///
/// @return variance of the sum of the filled heights, by zone [m^2]
std::vector<double> fill_shadows(const ShadowedScans& scans, ChangedGround& ground);

}  // namespace excavplan
