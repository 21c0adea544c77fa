// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/change/change_options.hpp>
#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/registration.hpp>

namespace excavplan {

/// Volumes from two surfaces of the whole scene.
///
/// Corrects the surface after for the motion of the alignment, removes objects that are no soil,
/// and finds the connected zones whose change exceeds the noise of the stable ground. In each zone
/// it sums the signed difference, which has no clipping bias, unlike the sum of positive parts, and
/// subtracts the error that the stable ground around the zone predicts there: kriging with the
/// covariance of that ground and with the motion that may be left. Unknown cells are filled by a
/// thin plate, in the scan that misses them or in the difference, whichever errs less where it is
/// tried on known cells.
///
/// Each zone is a change that belongs to the dig or not: by its shape, its place and the balance of
/// the soil the likeliest combination is counted, and what is open is listed
/// (`docs/methods.md#attribution`). What rose within the spill distance of the hole is spill, what
/// rose elsewhere the heap; if nothing did, that is the largest rise beside the hole that holds at
/// least half of the dug volume. The centre of a zone decides whether it lies in a given area.
///
/// Warnings: no_hole_found; no_dumped_soil (less than half of the dug volume rose, or a fifth away
/// from the hole); looks_swapped (after / before below 0.97 beyond its error, or above 3);
/// attribution_open; stirred_ground; other_change; object_taken_out; zone_at_border;
/// zone_partly_unseen; zone_unseen; sensor_place_inferred; little_stable_ground (under 40 %);
/// scans_do_not_fit; systematic_errors; earlier_soil.
///
/// @throws Error (bad_input) if the surfaces are not on one grid, share fewer than 100 known cells,
///         or an option is out of range
VolumeChange measure_change(const SurfacePair& scene, const ChangeOptions& options = {});

/// Volumes from separate surfaces of the dig area and of the dump area (the paper's four clouds).
/// @throws Error (bad_input) as for a whole scene
VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const ChangeOptions& options = {});

/// The same where the ground before is known (docs/methods.md#known-ground): `before` is the bank
/// that was cut and `after` its volume since, without loose soil that was dug again and, where the
/// swept floor is told, with what fell back on it. No hump is doubted (earlier_soil), and
/// VolumeChange::cut says what was cut. Of two areas it is that of the dig.
/// @throws Error (bad_input) as for surfaces, or if a layer has another size
VolumeChange measure_change(const SurfacePair& scene, const KnownGround& known,
                            const ChangeOptions& options = {});
VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const KnownGround& known, const ChangeOptions& options = {});

/// Volumes from height maps of the whole scene: the noise is that of the stable ground, and nothing
/// moved between the scans but the datum. @throws Error (bad_input) as for surfaces
VolumeChange measure_change(const HeightMap& before, const HeightMap& after,
                            const ChangeOptions& options = {});

/// Height maps of one area before and after a dig, on one grid.
struct HeightMapPair {
  HeightMap before;  ///< before the dig
  HeightMap after;   ///< after it
};

/// The same of the dig area and of the dump area. @throws Error (bad_input) as for surfaces
VolumeChange measure_change(const HeightMapPair& dig, const HeightMapPair& dump,
                            const ChangeOptions& options = {});

}  // namespace excavplan
