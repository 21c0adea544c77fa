// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/volume_change.hpp>

/// @file
/// Hard soil breaks into blocks that lie with voids between them. A height map counts the voids as
/// soil, so the bulking factor leaves the range of the density law. The surface tells: blocks are
/// rough over a span of decimetres, and steeper than loose soil can stand (docs/methods.md#blocks).

namespace excavplan {

/// Settings of assess_blocks(). Defaults without a source are ours.
struct BlockOptions {
  double angle_of_repose = 0.62;   ///< of the loose soil [rad], in (0, 1.2)
  std::optional<double> noise_sd;  ///< of one cell of `after` [m]; else what measure_change() found
  double packed_voids = 0.44;     ///< share of voids deep inside a heap of blocks [-]: 0.35 to 0.50
                                  ///< in loosely tipped angular blocks with their crumbs
  double packed_voids_sd = 0.07;  ///< what is not known of it [-]
};

/// How rough a patch of ground is. Roughness, steepness and dispersion are free of what the noise
/// of the scan adds in the mean.
struct GroundTexture {
  int cells = 0;                ///< that had enough known neighbours to be judged
  double fine_roughness = 0.0;  ///< median rms about the plane of 3 x 3 cells [m]
  double coarse_roughness =
      0.0;                   ///< the same about a curved window of 0.3 m, 5 x 5 cells or more [m]
  double steep_share = 0.0;  ///< of cells that stand 10 deg and more above the repose [-]
  double normal_dispersion = 0.0;  ///< rms angle from cell to window [rad]
  double hole_share = 0.0;         ///< of cells unseen, beyond the share unseen around it [-]
  double rough_share = 0.0;        ///< of windows too rough for loose soil [-]
  double score = 0.0;              ///< 0: loose soil, 1: blocks; 0 with too few cells
};

struct BlockReport {
  GroundTexture heap;   ///< all that rose: dumped and spilled soil
  GroundTexture pit;    ///< the hole; its walls may be steep, so only its roughness counts
  double score = 0.0;   ///< the larger of both
  bool blocks = false;  ///< the score is 0.5 or more: the density is not to be trusted
  std::optional<double> block_size;  ///< mean edge [m]; of the heap, if its texture tells it
  std::optional<Measured> voids;     ///< between the blocks, in `after` of the change [m^3]
  std::vector<std::string> reasons;  ///< for people: what was found and what loose soil would show
};

/// Looks for blocks in what changed, and where their size can be told estimates the voids between
/// them: voids = after * rough share * packed voids * f(size / depth of the heap). Volume without
/// voids = change.after - voids. Ours, set on simulated heaps and measured on
/// others of the same generator: size to 8 %, voids to 5 % of the heap's volume; to 15 % and 7 %
/// where blocks are flat or long, which it was not set on. No heap of real blocks was measured.
/// Nothing is estimated where the heap shows no blocks, where they are smaller
/// than three cells, or larger than the heap is deep. Cells above 0.2 m tell nothing: score 0 and
/// the reason.
///
/// @param after the height map of each area of `change`, on the grid of its difference
/// @throws Error (bad_input) if an option is out of range or a map is not on the grid of its area
BlockReport assess_blocks(const std::vector<HeightMap>& after, const VolumeChange& change,
                          const BlockOptions& options = {});

}  // namespace excavplan
