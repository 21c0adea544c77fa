// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/density/other_volumes.hpp>
#include <excavplan/density/soil_answers.hpp>
#include <excavplan/density/successive_density.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// What estimate_density() is asked: the scans of a dig, and what is known beside them.

namespace excavplan {

/// The scans of one dig.
struct DigScans {
  /// Of the whole scene or, with `dump`, of the dig area alone. Without files and clouds the known
  /// ground stands for it (DensityOptions::ground).
  Scan before;
  Scan after;                         ///< of the same area as `before`
  std::optional<ScanPair> dump = {};  ///< of the dump area: the paper's four clouds
};

/// How volumes are found.
enum class VolumeMethod {
  surface,  ///< signed change of one height map, measure_change()
  paper,    ///< DensityOptions::paper, as published, in the areas that the first finds
};

/// The dig as driven, for a law of digs along this path. With its start, which needs scans in the
/// site frame, the soil that fell back into the cut is measured too.
struct DugPath {
  Machine machine;                     ///< that drove it
  DigParameters parameters;            ///< of the path
  std::optional<double> start_x;       ///< where the path enters the ground [m]
  std::optional<double> start_z = {};  ///< and how high; else by the scan before [m]
  /// Where the bucket was emptied (x, y): in known ground only soil about there, or beside the
  /// hole, is of the dig [m].
  std::optional<Eigen::Vector2d> dump_at = {};
};

/// The ground that the dig can have changed: the bucket's way with a metre (ours) around it.
/// @throws Error (bad_input) without a start
Rectangle worked_area(const DugPath& dug);

/// Where the heap of a bucket lies, also on what was dumped there before: within twice the radius
/// of a cone of the heaped capacity; ours. Nothing where DugPath::dump_at is not told.
std::optional<Rectangle> heap_area(const DugPath& dug);

/// Settings of estimate_density().
struct DensityOptions {
  VolumeMethod method = VolumeMethod::surface;  ///< how volumes are found
  std::optional<double> cell_size;  ///< of the height map, and voxel of the paper's method [m];
                                    ///< else cell_for() the sparsest scan
  bool registered = true;           ///< false: the sensor did not move, scans are not registered
  ChangeOptions change;             ///< dig area, dump area and more
  OtherVolumes paper;               ///< of VolumeMethod::paper: paper_change()
  std::optional<DugPath> dug_path;  ///< if it is known
  SoilKnowledge soil;               ///< its kind, or the kinds that it may be
  std::optional<Measured> payload_mass;  ///< moist soil that was dumped, if it was weighed [kg]
  /// Of the joints in the dig, joint_work() [J]; needs the dug path with its start and the kind.
  std::optional<Measured> joint_work;
  /// The ground before as it is known, in the site frame of the scans: k is then of the bank alone
  /// (docs/methods.md#known-ground).
  std::optional<GroundState> ground;
  /// Where the machine worked, which does not register the scans; else about `dug_path`. For
  /// `ground`.
  std::optional<Rectangle> worked_area = {};
  double scan_time = 0.0;             ///< of the scan after, since 1970-01-01 UTC, for `ground` [s]
  std::optional<PriorDensity> prior;  ///< by digs before this one in the same soil
  unsigned threads = 0;               ///< 0: one per core; the result is the same for any number
};

}  // namespace excavplan
