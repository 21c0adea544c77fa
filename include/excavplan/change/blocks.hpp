// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/change/dig_volumes.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file
/// Hard soil breaks into blocks with voids between them. A height map counts the voids as soil, so
/// that the bulking factor leaves the range of the density law. The surface shows blocks: it is
/// rough over decimetres and steeper than loose soil can stand (`docs/methods.md#blocks`).

namespace excavplan {

/// Settings of assess_blocks(). Defaults without a source are ours.
struct BlockOptions {
  double angle_of_repose = 0.62;   ///< of the loose soil [rad], in (0, 1.2)
  std::optional<double> noise_sd;  ///< of one cell of `after` [m]; else what measure_change() found
  /// Share of voids deep inside a heap of blocks [-]: 0.35 to 0.50 in loosely tipped angular blocks
  /// with their fines.
  double packed_voids = 0.44;
  double packed_voids_sd = 0.07;  ///< its standard deviation [-]
};

/// How rough a patch of ground is. Roughness, steepness and dispersion are corrected for the mean
/// effect of the scan's noise.
struct GroundTexture {
  int cells = 0;                ///< with enough known neighbours
  double fine_roughness = 0.0;  ///< median rms about the plane of 3 x 3 cells [m]
  /// The same about a curved window of 0.3 m, 5 x 5 cells or more [m].
  double coarse_roughness = 0.0;
  double steep_share = 0.0;        ///< of cells 10 deg or more steeper than the angle of repose [-]
  double normal_dispersion = 0.0;  ///< rms angle from cell to window [rad]
  double hole_share = 0.0;         ///< of cells unseen, beyond the share unseen around it [-]
  double rough_share = 0.0;        ///< of windows too rough for loose soil [-]
  double score = 0.0;              ///< 0: loose soil, 1: blocks; 0 with too few cells
};

/// Evidence of blocks.
struct BlockReport {
  GroundTexture heap;   ///< all that rose: dumped and spilled soil
  GroundTexture pit;    ///< the hole; its walls may be steep, so only its roughness counts
  double score = 0.0;   ///< the larger of both
  bool blocks = false;  ///< the score is 0.5 or more: the density cannot be trusted
  std::optional<double> block_size;  ///< mean edge [m]; of the heap, if its texture shows it
  std::optional<Measured> voids;     ///< between the blocks, in `after` of the change [m^3]
  std::vector<std::string> reasons;  ///< text: what was found, and the value for loose soil
};

/// Looks for blocks in the ground that changed. Where their size can be found, it estimates the
/// voids between them: voids = after * rough share * packed voids * f(size / depth of the heap).
/// The volume without voids is change.after - voids.
///
/// The method is ours. It was tuned on simulated heaps and tested on others of the same generator:
/// size to 8 %, voids to 5 % of the volume of the heap; to 15 % and 7 % where blocks are flat or
/// long, for which it was not tuned. No heap of real blocks was measured. Voids are not estimated
/// where the heap shows no blocks, or blocks smaller than three cells or larger than the heap is
/// deep. With cells above 0.2 m the score is 0, with a reason; of cells below 1 cm only one in
/// each 1 to 2 cm is looked at.
///
/// @param after height map of each area of `change`, on the grid of its difference
/// @param change from measure_change()
/// @param options settings
/// @throws Error (bad_input) if an option is out of range or a map is not on the grid of its area
BlockReport assess_blocks(const std::vector<HeightMap>& after, const VolumeChange& change,
                          const BlockOptions& options = {});

}  // namespace excavplan
