// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// Whether a machine can stand where the site frame puts it: its tracks on the plane z = 0
/// (docs/methods.md#machine).

namespace excavplan {

/// What the ground about the tracks tells of where the machine stands. Nothing where too little of
/// it is seen.
struct StandingGround {
  /// Of the ground, below the middle of those ends of the tracks beside which it is seen [m].
  std::optional<double> height;
  std::optional<double> rise_ahead;  ///< slope of the ground along x, positive uphill [rad]
  std::optional<double> rise_left;   ///< the same along y [rad]
  double seen = 0.0;                 ///< share of the metre about the tracks, 0 .. 1
  /// ground_above_tracks *, ground_below_tracks *, ground_tilted *, drop_at_tracks *,
  /// soil_under_tracks * and ground_at_tracks_unseen. Those marked * end trust.
  std::vector<Warning> warnings;
};

/// Judges the ground from the tracks to 6 m about them (standing_extent()).
///
/// A plane is fitted to the cells within 1 m of the tracks (ours). It is the one that most of them
/// lie on, so that a wall or a heap beside the machine does not turn it, and must lie within 0.2 m
/// of z = 0 and 3 degrees of level; its slope is only told in a direction in which it is seen on
/// both sides. Ground that lies 0.5 m or more below the tracks must not come as near to them as it
/// is deep, except in the machine's own cut straight ahead, 0.4 m before them or further. Under the
/// tracks nothing may rise above them.
///
/// @param ground  on any grid, in the site frame; NaN where it is not seen
/// @throws Error (bad_input) as require_machine(), or if the map is no grid
StandingGround standing_ground(const Machine& machine, const HeightMap& ground);

/// The present ground, and where that is unknown an earlier one, on any grid.
HeightMap known_from_both(const HeightMap& present, const HeightMap& earlier);

}  // namespace excavplan
