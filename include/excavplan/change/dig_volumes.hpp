// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/measured.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/change/known_ground.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file
/// The volumes of one dig, and which changes of the ground belong to it
/// (`docs/methods.md#attribution`).

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
  Eigen::ArrayXXd filled =
      {};  ///< as `difference`, of unknown cells that count in a zone [m]; NaN elsewhere
};

/// What a change of the ground looks like.
enum class ChangeKind {
  hole,          ///< the largest fall
  second_hole,   ///< another that is as deep as a dig
  small_hole,    ///< one of less than 3 % of the hole
  settled,       ///< ground that fell a little
  edge,          ///< low ground that a hole or a heap runs out into
  heap,          ///< the largest rise away from the hole
  second_heap,   ///< another rise away from the hole
  spill,         ///< soil beside a hole
  clods,         ///< small rises between hole and heap
  small_rises,   ///< small rises elsewhere
  lump,          ///< steep and rounded: soil, or a thing
  thing,         ///< steep, with a level top
  ruts,          ///< of tracks or wheels; a lone one may be a shallow scrape
  berms,         ///< soil that tracks pushed aside
  stirred,       ///< ground that rose and fell in many small places
  within_error,  ///< less than two standard deviations
  in_area,       ///< in an area that was given for it
  outside_area,  ///< outside of it
  earlier_soil,  ///< loose soil of an earlier dig that was dug with the hole
  pressed,       ///< ground under the heap that gave way; no scan shows it
  water,         ///< over the floor of the hole; no scan shows it
};

/// "hole", "second_hole", ...: the names above.
const char* name(ChangeKind kind);

/// A change that was left out of the volumes and might belong to the dig, or was counted and might
/// not.
struct AttributedChange {
  ChangeKind kind = ChangeKind::hole;  ///< what it looks like
  std::string what;                    ///< text: likewise, and where
  Measured volume;                     ///< of the change, > 0 where the ground rose [m^3]
  bool counted = false;                ///< it is part of hole, spill or heap
  double probability = 0.0;            ///< that it belongs to the dig, 0 .. 1
};

/// The bulking factor if some open changes are attributed the other way.
struct Reading {
  std::vector<ChangeKind> kinds;  ///< of these changes; none for the scene as it was counted
  std::string what;               ///< text: what is taken to be so
  double weight = 0.0;            ///< its probability; those of all readings add up to 1
  Measured bulking;               ///< k with the error of scans and of this reading [-]
};

/// No scan shows whether the reading is true: it has a prior weight alone, and is in no interval.
bool is_unseen(const Reading& reading);

/// Covariance of (excavated, spilled, dumped) by source [m^6].
struct VolumeErrors {
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();        ///< of each cell on its own
  Eigen::Matrix3d correlated = Eigen::Matrix3d::Zero();   ///< that neighbouring cells share
  Eigen::Matrix3d datum = Eigen::Matrix3d::Zero();        ///< motion left between the scans
  Eigen::Matrix3d holes = Eigen::Matrix3d::Zero();        ///< ground that no scan saw
  Eigen::Matrix3d faces = Eigen::Matrix3d::Zero();        ///< position of steep faces
  Eigen::Matrix3d thin = Eigen::Matrix3d::Zero();         ///< soil too thin to tell from noise
  Eigen::Matrix3d attribution = Eigen::Matrix3d::Zero();  ///< changes that are open
  Eigen::Matrix3d loose = Eigen::Matrix3d::Zero();        ///< loose soil that was dug again

  /// Covariance by the scans alone.
  Eigen::Matrix3d scans() const { return noise + correlated + datum + holes + faces + thin; }
  /// Covariance by all sources.
  Eigen::Matrix3d total() const { return scans() + attribution + loose; }
};

/// Volumes of one dig [m^3]: before = excavated, after = spilled + dumped (the paper's eqs. 3, 4).
struct VolumeChange {
  Measured excavated;  ///< the hole
  Measured spilled;    ///< soil that rose beside it
  Measured dumped;     ///< the heap
  Measured before;     ///< undisturbed volume of the dug soil: the hole; with `cut` the bank cut
  Measured
      after;  ///< its loose volume: spill and heap; with `cut` `before` and what rose on the whole
  /// Change of the ground that did not change enough for a zone, within 0.6 m of hole, spill and
  /// heap and above that farther away: the sum without a threshold
  Measured outside;
  Measured strewn;                       ///< what of it is counted as soil, in `spilled`
  double covariance_before_after = 0.0;  ///< [m^6]
  VolumeErrors errors;                   ///< the variances by source
  std::optional<KnownCut> cut;           ///< of a dig in ground that is known
  Eigen::Matrix3d shared = Eigen::Matrix3d::Zero();  ///< of `errors`: what the scan before made
  std::vector<ChangeZone> zones;                     ///< of all areas
  std::vector<AreaChange> areas;  ///< one for a whole scene, two for a dig and a dump area
  std::vector<Warning> warnings;  ///< codes: measure_change()
  std::vector<AttributedChange> attribution;  ///< changes that are open
  std::vector<Reading> readings;  ///< of the scene, likeliest first; empty if one alone is likely
};

}  // namespace excavplan
