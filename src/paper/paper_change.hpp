// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/change/volume_change.hpp>
#include <excavplan/paper/paper_options.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file The paper's method on scans that were not cropped by hand. Private to the library.

namespace excavplan {

/// The scans of dig area and dump area, the same ones for a whole scene.
struct PaperScans {
  const ScanPair& dig;
  const ScanPair* dump = nullptr;  ///< none: `dig` shows both
};

/// Where and how the volumes are summed.
struct PaperSettings {
  ChangeOptions change;  ///< its dig area and dump area
  double leaf = 0.0;     ///< edge of the voxels [m]
  PaperOptions paper;    ///< the rest
};

/// Volumes as published, each in its area: that of the options or, in a whole scene, the extent of
/// the zones that the change of the surface found there. Where both overlap, soil counts in the
/// area of its zone. Zones, height change and warnings of the result are those of the surface.
/// @throws Error (bad_file) naming the scans
VolumeChange paper_change(const PaperScans& scans, const VolumeChange& surface,
                          const PaperSettings& settings);

}  // namespace excavplan
