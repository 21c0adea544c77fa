// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <excavplan/scans/scan_surface.hpp>

#include "scans/scan_reading.hpp"

/// @file Two scans of one piece of ground, and their surfaces on each other. Private to the
/// library.

namespace excavplan {

/// A pair of scans and their outlines.
struct OutlinedPair {
  ScanPair scans;
  ScanOutline before;
  ScanOutline after;

  /// Of the survey: no larger than points allow, as walls and narrow zones are lost in large ones.
  double cell_size() const { return survey_cell({before, after}); }
  double registration_cell() const { return cell_for({before, after}); }
  std::uint64_t machine_points() const { return before.machine_points + after.machine_points; }
  std::string names() const { return name_of(scans.before) + ", " + name_of(scans.after); }
};

/// @throws Error (bad_file) if one cannot be read or holds fewer than 100 finite points
OutlinedPair outlined(const ScanPair& scans, unsigned threads);
/// @param before, after  outlines of the scans
OutlinedPair outlined(const ScanPair& scans, const ScanOutline& before, const ScanOutline& after);

/// How far a correction moves the middle of the ground, and by what angle it turns it.
struct Displacement {
  double shift = 0.0;  ///< [m]
  double turn = 0.0;   ///< [rad]

  /// Beyond three standard deviations of the priors of align().
  bool is_beyond_prior() const;
};
Displacement displacement_by(const Eigen::Matrix4d& correction, const Eigen::Vector3d& centre);

/// The scan with its points moved; its area stays.
Scan corrected(const Scan& scan, const Eigen::Matrix4d& correction);

/// True if the ground that did not change differs by over 10 mm, and by three times what the
/// scatter of the points explains.
bool leaves_difference(const SurfacePair& pair);

/// Both on one grid over the ground that both see. If they are to be registered, the one after is
/// registered to the one before on the ground that did not change, as far as the motion is
/// significant; else only their relative height is undetermined.
/// @param grid  where corners of cells meet; else they move with the scans
/// @throws FrameError if they do not overlap
RegisteredPair survey_pair(const OutlinedPair& pair, double cell_size, bool registered,
                           unsigned threads,
                           const std::optional<Eigen::Vector2d>& grid = std::nullopt);

}  // namespace excavplan
