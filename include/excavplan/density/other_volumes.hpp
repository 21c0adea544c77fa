// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/scans/scan_surface.hpp>

namespace excavplan {

/// A dig whose volumes are measured in another way than by measure_change().
struct SurveyedDig {
  const ScanPair& scans;           ///< of the whole scene or, with `dump`, of the dig area
  const ScanPair* dump = nullptr;  ///< of the dump area; null: `scans` shows both
  const VolumeChange& surface;     ///< by measure_change(), for its zones
  const ChangeOptions& options;    ///< dig area, dump area and more
  double cell_size = 0.0;          ///< of the height maps [m]
};

/// Another way to measure the volumes of a dig. Errors that it throws are told of the scans, as
/// Error (bad_file).
using OtherVolumes = std::function<VolumeChange(const SurveyedDig&)>;

}  // namespace excavplan
