// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>

#include "base/random.hpp"
#include "sensing/block_heap.hpp"

/// @file
/// Heaps for tests whose solids are known: blocks dropped one by one, which roll down to where they
/// rest, and loose soil. Fine grids of 1 cm, averaged to the cells of a survey afterwards.

namespace excavplan::test {

constexpr double fine_cell = 0.01;
constexpr Rectangle heap_ground = {0.0, 0.0, 4.5, 4.5};

struct Heap {
  HeightMap fine;       ///< what is seen from above
  double solids = 0.0;  ///< volume of the blocks, or of the loose soil as a whole [m^3]
  double envelope() const { return fine.z.sum() * fine_cell * fine_cell; }
  double voids() const { return envelope() - solids; }
};

struct BlockHeapOptions {
  double size = 0.20;    ///< mean edge of a block [m]
  double spread = 0.25;  ///< of the logarithm of the edges [-]
  double solids = 0.40;  ///< volume of the blocks [m^3]
  double repose = 0.55;  ///< gradient down which a block still rolls [-]
  int tries = 100;       ///< places and attitudes near by, of which a block rests in the lowest
  double crumbs = 0.0;   ///< share of the voids between blocks that fine soil fills [-]
  double cover = 0.0;    ///< fine soil evens out what is narrower than this [m]
};

/// Fine soil in what lies lower than the mean of its surroundings.
void cover(Heap& heap, double width);

/// Blocks dropped near the middle of `heap_ground`.
Heap block_heap(const BlockHeapOptions& options, std::uint64_t seed);

/// Smooth random heights of standard deviation 1 with a wavelength of some `length` [m].
Eigen::ArrayXXd random_heights(const HeightMap& on, double length, Random random);

struct LooseHeapOptions {
  double volume = 0.60;      ///< [m^3]
  double repose = 0.62;      ///< [rad]
  double roughness = 0.008;  ///< rms of its clods [m]
  double clod = 0.08;        ///< wavelength of them [m]
  int cones = 1;             ///< one behind the other, half a radius apart
};

/// Cones of loose soil with clods on them.
Heap loose_heap(const LooseHeapOptions& options, std::uint64_t seed);

/// Mean heights over the cells of a survey.
HeightMap surveyed(const HeightMap& fine, double cell);

}  // namespace excavplan::test
