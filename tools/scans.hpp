// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/survey/cloud.hpp>

namespace excavplan::tools {

/// What brings scans into the site frame and what part of them counts.
struct ScanFrames {
  std::optional<std::string> before;  ///< file with the matrix of the scans before
  std::optional<std::string> after;
  std::optional<Rectangle> area;  ///< points outside are left out
};

/// Two scans of one area in the site frame.
struct ScanPair {
  std::string before_file;
  std::string after_file;
  Cloud before;
  Cloud after;
  double density = 0.0;  ///< of the sparser scan [points/m^2 of ground]

  std::string files() const { return before_file + ", " + after_file; }
};

/// @throws Error (bad_file) if one cannot be read or holds fewer than 100 finite points
ScanPair read_scans(const std::string& before, const std::string& after, const ScanFrames& frames);

/// Cell that holds six points of the sparser scan, 0.05 m at least; ours.
double cell_for(const ScanPair& scans);

/// Both scans on one grid over the ground that both see.
/// @throws Error (bad_file) if they do not overlap
SurfacePair surfaces(const ScanPair& scans, double cell);

}  // namespace excavplan::tools
