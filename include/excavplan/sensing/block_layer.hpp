// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Hard soil falls as blocks with voids between them (docs/methods.md#rehearsal). Numbers are ours.
struct BlockSettings {
  double size = 0.15;  ///< mean edge of a block, at least 4 cm and at most 1 m [m]
  /// Share of its swelling that the soil of a block has gone through [-], in 0 .. 1: 1 is cracked
  /// soil as loose as dumped soil is by its law, 0 is undisturbed soil.
  double swell = 1.0;
  double fines = 0.3;           ///< share of the voids that fine soil fills [-], in 0 .. 1
  double least_density = 80.0;  ///< softer ground crumbles [%]
  std::uint64_t seed = 1;       ///< of shapes and places
};

/// Loose soil as blocks.
struct BlockLayer {
  HeightMap before;    ///< the ground before the dig, on finer cells
  HeightMap after;     ///< with the blocks
  int count = 0;       ///< of blocks
  double soil = 0.0;   ///< volume of blocks and fines [m^3]
  double voids = 0.0;  ///< between and under them, as seen from above, without the fines [m^3]
};

}  // namespace excavplan
