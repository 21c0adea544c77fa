// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/error.hpp>
#include <excavplan/change/attribution.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/registration.hpp>
#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// Kind of a change of the ground.
enum class ZoneKind {
  dig,    ///< the hole
  spill,  ///< soil that rose beside the hole
  dump,   ///< soil that rose away from the hole
  other,  ///< changed, but neither: excluded from all volumes
};

/// "dig", "spill", "dump" or "other".
const char* name(ZoneKind kind);

/// A connected piece of ground that changed by more than the noise.
struct ChangeZone {
  ZoneKind kind = ZoneKind::other;  ///< hole, spill, heap or none of them
  Measured volume;                  ///< of the change, > 0 where the ground rose [m^3]
  double area = 0.0;                ///< [m^2]
  double unknown_share = 0.0;  ///< share of its cells that no scan saw and that were filled [-]
  Rectangle extent;            ///< of all its cells
};

/// Change of the ground in one surveyed area.
struct AreaChange {
  HeightMap difference;   ///< after - before [m] less datum, stripes and doming; NaN where unknown
  Eigen::ArrayXXi zone;   ///< index into VolumeChange::zones, -1 for stable ground
  double noise_sd = 0.0;  ///< of one stable cell of `difference`, at least 0.1 mm [m]
  double datum = 0.0;     ///< robust mean change of stable ground, taken off `difference` [m]
  Eigen::ArrayXXd sd;     ///< of `difference`, but for that of the datum [m]; NaN where unknown
};

/// Settings of measure_change(). The defaults are ours, found by experiment
/// (`docs/methods.md#volumes`).
struct ChangeOptions {
  std::optional<Rectangle> dig_area;   ///< only falling ground in here is the hole
  std::optional<Rectangle> dump_area;  ///< only rising ground in here is the heap
  double detection = 5.0;  ///< a zone has a 3 x 3 mean of at least this many of its sd [-], > 0
  double growth = 3.0;     ///< and grows to cells of this many sd [-], in (0, detection]
  double min_zone_area = 0.03;  ///< smaller zones are noise [m^2], >= 0
  /// Zones and objects are widened by this or a cell at least, and more where noise hides their
  /// thin edge [m], >= 0.
  double margin = 0.05;
  double spill_distance = 0.6;     ///< rising ground this near to the hole is spill [m], >= 0
  double max_unknown_share = 0.2;  ///< more unknown cells in a zone give a warning [-]
  /// With more unknown cells in a hole, spill or heap, unless it is a small part of its kind,
  /// bulking_factor() refuses the volumes [-]; not below max_unknown_share
  double refused_unknown_share = 0.5;
};

/// Covariance of (excavated, spilled, dumped) by source [m^6].
struct VolumeErrors {
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();        ///< of each cell on its own
  Eigen::Matrix3d correlated = Eigen::Matrix3d::Zero();   ///< that neighbouring cells share
  Eigen::Matrix3d datum = Eigen::Matrix3d::Zero();        ///< motion left between the scans
  Eigen::Matrix3d holes = Eigen::Matrix3d::Zero();        ///< ground that no scan saw
  Eigen::Matrix3d faces = Eigen::Matrix3d::Zero();        ///< position of steep faces
  Eigen::Matrix3d thin = Eigen::Matrix3d::Zero();         ///< soil too thin to tell from noise
  Eigen::Matrix3d attribution = Eigen::Matrix3d::Zero();  ///< changes that are open

  /// Covariance by the scans alone.
  Eigen::Matrix3d scans() const { return noise + correlated + datum + holes + faces + thin; }
  /// Covariance by all sources.
  Eigen::Matrix3d total() const { return scans() + attribution; }
};

/// Volumes of one dig [m^3]: before = excavated, after = spilled + dumped (the paper's eqs. 3, 4).
struct VolumeChange {
  Measured excavated;                    ///< the hole
  Measured spilled;                      ///< soil that rose beside it
  Measured dumped;                       ///< the heap
  Measured before;                       ///< undisturbed volume of the dug soil
  Measured after;                        ///< its loose volume
  double covariance_before_after = 0.0;  ///< [m^6]
  VolumeErrors errors;                   ///< the variances by source
  std::vector<ChangeZone> zones;         ///< of all areas
  std::vector<AreaChange> areas;         ///< one for a whole scene, two for a dig and a dump area
  std::vector<Warning> warnings;         ///< codes: measure_change()
  std::vector<AttributedChange> attribution;  ///< changes that are open
  std::vector<Reading> readings;  ///< of the scene, likeliest first; empty if one alone is likely
};

/// Surfaces of one area before and after a dig, on one grid, and their alignment.
struct SurfacePair {
  Surface before;       ///< before the dig
  Surface after;        ///< after it
  Alignment alignment;  ///< align(before, after), or what is known otherwise
};

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
