// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// Ground to dig on as a scan shows it.
struct ScannedTerrain {
  /// Undisturbed; unknown where the scan does not see, and below its obstacles.
  Terrain terrain;
  /// Scan::doubts, outliers (points without data, left out), two_surfaces, unseen_ground,
  /// sparse_terrain; those of the terrain too.
  std::vector<Warning> warnings;
};

/// The ground of `extent` on cells of `cell_size` [m], in the site frame (origin on the machine's
/// swing axis at ground level, x forward).
///
/// A scan with fewer than 2 points per cell is rasterised on larger cells and interpolated
/// (sparse_terrain). Gaps of up to 0.3 m or 3 cells are filled; what lies in wider ones stays
/// unknown (unseen_ground), and no dig is planned there. Points on two surfaces, one above the
/// other, as of scans with different poses, are told (two_surfaces) and end trust on 3 % of the
/// ground. What stands on the ground, to 3 m around the extent but not behind its x_min, is told by
/// its shape (docs/methods.md#motion). Files are read several times and not held.
///
/// @throws Error (bad_file) if a file cannot be read or changes meanwhile; FrameError with fewer
/// than 10 points within a metre of the extent; (bad_input) unless cell_size > 0
ScannedTerrain terrain_from_scan(const Scan& scan, const Rectangle& extent, double cell_size);

/// Ground that a motion must be clear of: swing_extent() in cells of usual_cell(). It is known
/// between points at most 0.25 m apart, and not between points more than 0.5 m apart (ours), as
/// high as its highest return, with all that stands on it or hangs over it. Returns of tracks and
/// upper structure, facing the dig, and above the reach do not count. The warnings are
/// Scan::doubts.
/// @throws Error as terrain_from_scan()
ScannedTerrain swing_terrain_from_scan(const Scan& scan, const Machine& machine);

/// Ground that a machine stands on: standing_extent() in cells twice as large as usual_cell(); with
/// no more than 10 points there all of it is unknown.
/// @throws Error (bad_file) if a file cannot be read or changes meanwhile
HeightMap standing_ground_from_scan(const Scan& scan, const Machine& machine);

/// The present ground, and where that is unknown an earlier one of the surroundings, both of
/// swing_terrain_from_scan(), with obstacles as with_earlier_obstacles(). Warning
/// surroundings_differ, which ends trust, if they differ in height, shift, turn or relief where
/// both are known (docs/methods.md#motion): the frame of one is wrong. Level ground with nothing on
/// it shows neither shift nor turn.
/// @throws Error (bad_input) if their cells differ
ScannedTerrain with_surroundings(const Terrain& present, const Terrain& earlier);

/// The present ground with what stood on it or hung over it before, unless the present scan shows
/// that it has gone: ground in the place of anything but a wire or a post, which no ray need hit.
/// @throws Error (bad_input) if their cells differ
Terrain with_earlier_obstacles(const Terrain& present, const Terrain& earlier);

}  // namespace excavplan
