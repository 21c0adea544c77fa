// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/volume_change.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>

namespace excavplan {

/// Soil that fell back into a cut whose path is known.
struct Fallback {
  double cut = 0.0;     ///< what the bucket swept out of the ground before [m^3]
  double in_pit = 0.0;  ///< lies on the swept floor now [m^3]
  Measured fraction;    ///< in_pit / cut, inside 0 .. 1, for free_of_fallback() [-]
  double seen_share =
      0.0;  ///< of the swept ground that both maps know; the rest is taken alike [-]
};

/// How well a machine follows its path in height [m]; ours: GNSS-guided excavators hold 1-2 cm.
inline constexpr double usual_tracking_sd = 0.015;

/// Compares the ground after a dig with the floor that the tip has swept, over the bucket's width.
///
/// The difference is summed with its sign, so noise does not become soil. Both maps are in the site
/// frame, on one grid.
///
/// @param tracking_sd  of the height of the whole path against the ground [m]
/// @throws Error (bad_input) if the maps are not on one grid, the path does not dig, or less than
///         half of what it swept is known
Fallback measure_fallback(const Machine& machine, const DigPath& path, const HeightMap& before,
                          const HeightMap& after, double tracking_sd = usual_tracking_sd);

}  // namespace excavplan
