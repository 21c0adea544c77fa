// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Settings of measure_change(). The defaults are ours, found by experiment
/// (`docs/methods.md#volumes`).
struct ChangeOptions {
  std::optional<Rectangle> dig_area;   ///< only falling ground in here is the hole
  std::optional<Rectangle> dump_area;  ///< only rising ground in here is the heap
  /// Ground that rose outside, away from the hole, is none of the dig; what rose inside may be.
  std::optional<Rectangle> heap_near = {};
  double detection = 5.0;  ///< a zone has a 3 x 3 mean of at least this many of its sd [-], > 0
  double growth = 3.0;     ///< and grows to cells of this many sd [-], in (0, detection]
  double min_zone_area = 0.03;  ///< smaller zones are noise [m^2], >= 0
  /// Zones and objects are widened by this or a cell at least, and more where noise hides their
  /// thin edge [m], >= 0.
  double margin = 0.05;
  double spill_distance = 0.6;  ///< rising ground this near to the hole is spill [m], >= 0
  /// What neighbouring points of one scan have in common, as its sensor is stated to err [m], >= 0:
  /// stable ground that differs by no more than that explains does not speak against the scans.
  double sensor_pattern_sd = 0.0;
  double max_unknown_share = 0.2;  ///< more unknown cells in a zone give a warning [-]
  /// With more unknown cells in a hole, spill or heap, unless it is a small part of its kind,
  /// bulking_factor() refuses the volumes [-]; not below max_unknown_share
  double refused_unknown_share = 0.5;
};

}  // namespace excavplan
