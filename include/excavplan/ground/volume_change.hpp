// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/error.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/registration.hpp>
#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// A figure with its standard deviation, in the unit of the figure.
struct Measured {
  double value = 0.0;
  double sd = 0.0;
};

enum class ZoneKind {
  dig,    ///< the hole
  spill,  ///< soil that rose beside the hole
  dump,   ///< soil that rose away from the hole
  other,  ///< changed, but neither: left out of every volume
};

const char* name(ZoneKind kind);

/// A connected piece of ground that truly changed.
struct ChangeZone {
  ZoneKind kind = ZoneKind::other;
  Measured volume;             ///< of the change, > 0 where the ground rose [m^3]
  double area = 0.0;           ///< [m^2]
  double unknown_share = 0.0;  ///< share of its cells that no scan saw and that were filled [-]
  Rectangle extent;
};

/// What happened in one surveyed area.
struct AreaChange {
  HeightMap difference;   ///< after - before [m], less the datum; NaN where either is unknown
  Eigen::ArrayXXi zone;   ///< index into VolumeChange::zones, -1 for stable ground
  double noise_sd = 0.0;  ///< of one stable cell of `difference`, at least 0.1 mm [m]
  double datum = 0.0;     ///< robust mean change of the stable ground, taken off `difference` [m]
};

/// Settings of measure_change(). The defaults are ours, found by experiment
/// (docs/methods.md#volumes).
struct ChangeOptions {
  std::optional<Rectangle> dig_area;   ///< only falling ground in here is the hole
  std::optional<Rectangle> dump_area;  ///< only rising ground in here is the heap
  double detection = 5.0;  ///< a zone holds a 3 x 3 mean of at least this many of its sd [-], > 0
  double growth = 3.0;     ///< and grows to cells of this many sd [-], in (0, detection]
  double min_zone_area = 0.03;  ///< smaller zones are noise [m^2], >= 0
  double margin = 0.05;  ///< zones and objects are widened by this or a cell at least, and more
                         ///< where noise hides their feathered edge [m], >= 0
  double spill_distance = 0.6;     ///< rising ground this near to the hole is spill [m], >= 0
  double max_unknown_share = 0.2;  ///< a zone with more unknown cells draws a warning [-]
  /// With more unknown cells in a hole, spill or heap, unless it is a small part of its kind,
  /// bulking_factor() refuses the volumes [-]; not below max_unknown_share
  double refused_unknown_share = 0.5;
};

/// Covariance of (excavated, spilled, dumped) by source [m^6].
struct VolumeErrors {
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();       ///< of each cell on its own
  Eigen::Matrix3d correlated = Eigen::Matrix3d::Zero();  ///< that neighbouring cells share
  Eigen::Matrix3d datum = Eigen::Matrix3d::Zero();       ///< motion left between the scans
  Eigen::Matrix3d holes = Eigen::Matrix3d::Zero();       ///< ground that no scan saw
  Eigen::Matrix3d faces = Eigen::Matrix3d::Zero();       ///< where points place steep faces

  Eigen::Matrix3d total() const { return noise + correlated + datum + holes + faces; }
};

/// Volumes of one dig [m^3]: before = excavated, after = spilled + dumped (the paper's eqs. 3, 4).
struct VolumeChange {
  Measured excavated;
  Measured spilled;
  Measured dumped;
  Measured before;
  Measured after;
  double covariance_before_after = 0.0;  ///< [m^6]
  VolumeErrors errors;                   ///< what the standard deviations are made of
  std::vector<ChangeZone> zones;
  std::vector<AreaChange> areas;  ///< one for a whole scene, two for a dig and a dump area
  std::vector<Warning> warnings;
};

/// Surfaces of one area before and after, on one grid, and how they lie against each other.
struct SurfacePair {
  Surface before;
  Surface after;
  Alignment alignment;  ///< align(before, after), or what is known otherwise
};

/// Volumes from two surfaces of the whole scene.
///
/// Takes the motion of the alignment off the after surface, objects that are no soil out of it,
/// and finds the connected zones whose change exceeds the noise found on the ground that did not.
/// Inside each zone it sums the signed difference, which unlike the sum of positive parts is free
/// of clipping bias, and takes off the error that the stable ground around the zone predicts
/// there (kriging with the covariance found on that ground and the motion that may be left).
/// Unknown cells are filled by a thin plate, in the scan that misses them or in the difference,
/// whichever errs less where it is tried on known cells.
///
/// Without a dig area the hole is the zone that lost most, with what fell within the spill distance
/// of it; without a dump area the heap is the zone that rose most away from the hole, with what
/// rose within the spill distance of that, or if nothing did, the largest rise beside the hole that
/// holds at least half of what was dug. Zones belong to a given area by their centre.
///
/// Warnings: no_hole_found; no_dumped_soil (less than half of the dug volume rose, or less than a
/// fifth away from the hole); looks_swapped (after / before below 0.97 beyond its error, or above
/// 3); other_change; object_taken_out; zone_at_border; zone_partly_unseen; zone_unseen (refused:
/// no bulking factor); little_stable_ground (under 40 %); scans_do_not_fit (noise above 0.1 m).
///
/// @throws Error (bad_input) if the surfaces are not on one grid, share fewer than 100 known cells,
///         or an option is out of range
VolumeChange measure_change(const SurfacePair& scene, const ChangeOptions& options = {});

/// Volumes from separate surfaces of the dig area and of the dump area (the paper's four clouds).
///
/// @throws Error (bad_input) as for a whole scene
VolumeChange measure_change(const SurfacePair& dig, const SurfacePair& dump,
                            const ChangeOptions& options = {});

/// As for surfaces, with noise as the stable ground shows it and nothing known to have moved but
/// the datum.
VolumeChange measure_change(const HeightMap& before, const HeightMap& after,
                            const ChangeOptions& options = {});

/// A map of one area before and after.
struct HeightMapPair {
  HeightMap before;
  HeightMap after;
};

VolumeChange measure_change(const HeightMapPair& dig, const HeightMapPair& dump,
                            const ChangeOptions& options = {});

}  // namespace excavplan
