// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/survey/scan_surface.hpp>

namespace excavplan::tools {

/// What brings scans into the site frame and what part of them counts.
struct ScanFrames {
  std::optional<std::string> before;  ///< file with the matrix of the scans before
  std::optional<std::string> after;
  std::optional<Rectangle> area;  ///< points outside are left out
};

/// A scan that stays in its file, and what a first look told of it.
struct SeenScan {
  Scan scan;
  ScanOutline outline;

  const std::string& file() const { return scan.files.front(); }
  /// All its points in the site frame, for methods that need them.
  /// @throws Error (bad_file)
  Cloud cloud() const;
};

/// Two scans of one area, with what brings them into the site frame.
struct SeenPair {
  SeenScan before;
  SeenScan after;

  std::string files() const { return before.file() + ", " + after.file(); }
};

/// @throws Error (bad_file) if one cannot be read or holds fewer than 100 finite points
SeenPair read_scans(const std::string& before, const std::string& after, const ScanFrames& frames);

/// That of excavplan::cell_for().
double cell_for(const SeenPair& scans);

/// Both scans on one grid over the ground that both see. With `align_them` the one after is brought
/// onto the one before by the ground that did not change, as far as that is significant; without,
/// only the height of one against the other is left open.
/// @throws Error (bad_file) if they do not overlap
RegisteredPair surveyed(const SeenPair& scans, double cell, bool align_them);

/// The heights of these, not aligned.
HeightMapPair surfaces(const SeenPair& scans, double cell);

}  // namespace excavplan::tools
