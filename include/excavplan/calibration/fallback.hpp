// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/base/measured.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>

namespace excavplan {

/// Soil that fell back into a cut whose path is known.
struct Fallback {
  double cut = 0.0;     ///< ground before that the bucket swept [m^3]
  double in_pit = 0.0;  ///< soil on the swept floor afterwards [m^3]
  Measured fraction;    ///< in_pit / cut, inside 0 .. 1, for free_of_fallback() [-]
  /// Share of the swept ground that is known in both maps; the rest is assumed to be alike [-].
  double seen_share = 0.0;
};

/// Standard deviation of a machine's height from its path [m]; ours: 1-2 cm with GNSS guidance.
inline constexpr double usual_tracking_sd = 0.015;

/// Compares the ground after a dig with the floor that the tip has swept, over the bucket's width.
/// The difference is summed with its sign, so that noise does not count as soil.
///
/// @param machine whose bucket dug
/// @param path that was dug
/// @param before ground before the dig, in the site frame
/// @param after ground after the dig, on the same grid
/// @param tracking_sd standard deviation of the height of the whole path [m]
/// @throws Error (bad_input) if the maps are not on one grid, the path does not dig, or less than
///         half of what it swept is known
Fallback measure_fallback(const Machine& machine, const DigPath& path, const HeightMap& before,
                          const HeightMap& after, double tracking_sd = usual_tracking_sd);

}  // namespace excavplan
