// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/survey/cloud.hpp>

namespace excavplan {

/// Settings of the paper's pipeline. The paper gives none of these; the values are those that
/// reference/point-cloud-volume section 3.2 assumes.
struct PaperMethodOptions {
  double leaf = 0.05;               ///< edge l of a voxel, also of the change detector [m], > 0
  int outlier_neighbours = 50;      ///< of StatisticalOutlierRemoval, > 0
  double outlier_deviations = 1.0;  ///< of StatisticalOutlierRemoval [-], > 0
};

/// The paper's section 2.2.2, on PCL's filters: points of the after-cloud in voxels that were empty
/// before (and of the before-cloud in voxels that are empty after, which carry nothing into V),
/// statistical outlier removal, voxel grid, then V(region, s) = sum (s z)^+ l^2 with z above the
/// ground plane.
///
/// Kept as published for comparison: slopes are counted up to four times and noise makes soil
/// (reference/point-cloud-volume section 3); no standard deviation is known, all are NaN.
/// The clouds must be levelled: z = 0 is the ground.
///
/// @throws Error (bad_input) if an option is out of range, or the extent over the leaf exceeds 2^31
/// voxels
VolumeChange paper_volumes(const Cloud& dig_before, const Cloud& dig_after,
                           const Cloud& dump_before, const Cloud& dump_after,
                           const PaperMethodOptions& options = {});

}  // namespace excavplan
