// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/survey/cloud.hpp>

namespace excavplan {

/// Settings of the paper's pipeline. The paper gives none of these; the values are ours: a common
/// leaf and the usual parameters of PCL's outlier removal.
struct PaperMethodOptions {
  double leaf = 0.05;               ///< edge l of a voxel, also of the change detector [m], > 0
  int outlier_neighbours = 50;      ///< of StatisticalOutlierRemoval, > 0
  double outlier_deviations = 1.0;  ///< of StatisticalOutlierRemoval [-], > 0
};

/// The paper's V(region, s) = sum (s z)^+ l^2 over one point per voxel of edge `leaf` = l [m], with
/// z above the ground plane z = 0 and `sign` s = +1 for soil above it, -1 for the hole below.
///
/// Not a volume where the ground is steep or noisy (docs/methods.md#volumes): a plane of gradient
/// (gx, gy) is counted 1 + |gx| + |gy| times, and flat ground with noise sigma gives
/// 0.8 sigma m^3 per m^2 either way.
///
/// @throws Error (bad_input) if the leaf is not positive, or the extent exceeds 2^31 voxels
double paper_volume(const Cloud& cloud, double sign, double leaf);

/// The paper's section 2.2.2, on PCL's filters: points of the after-cloud in voxels that were empty
/// before (those of the before-cloud in voxels that are empty after carry nothing into V),
/// statistical outlier removal, then paper_volume(): excavated = V(dig, -1), spilled = V(dig, +1),
/// dumped = V(dump, +1).
///
/// Kept as published for comparison; no standard deviation is known, all are NaN. The clouds must
/// be levelled: z = 0 is the ground.
///
/// @throws Error (bad_input) if an option is out of range, a cloud has no finite point, or the
/// extent of an area exceeds 2^31 voxels
VolumeChange paper_volumes(const Cloud& dig_before, const Cloud& dig_after,
                           const Cloud& dump_before, const Cloud& dump_after,
                           const PaperMethodOptions& options = {});

}  // namespace excavplan
