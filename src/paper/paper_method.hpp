// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/change/volume_change.hpp>
#include <excavplan/clouds/cloud.hpp>
#include <excavplan/paper/paper_options.hpp>

namespace excavplan {

/// Clouds of one area.
struct CloudPair {
  Cloud before;  ///< before the dig
  Cloud after;   ///< after it
};

/// The paper's V(region, s) = sum (s z)^+ l^2 over one point per voxel, with z above the ground
/// plane z = 0 and `sign` s = +1 for soil above it, -1 for the hole below. l = `leaf` is "the
/// side length of the voxel in the base plane" [m]: a column over a cell counts once, at the mean
/// height of its points.
///
/// With cubes a plane of gradient (gx, gy) is counted 1 + |gx| + |gy| times, and flat ground with
/// noise sigma gives 0.8 sigma m^3 per m^2 either way (docs/methods.md#volumes).
///
/// @throws Error (bad_input) if the leaf is not positive, or the extent exceeds 2^31 voxels
double paper_volume(const Cloud& cloud, double sign, double leaf,
                    PaperVoxels voxels = PaperVoxels::columns);

/// The paper's section 2.2.2, on PCL's filters: points of the after-cloud in cubes of edge `leaf`
/// [m] that were empty before (those of the before-cloud in cubes that are empty after carry
/// nothing into V), statistical outlier removal, then paper_volume(): excavated = V(dig, -1),
/// spilled = V(dig, +1), dumped = V(dump, +1).
///
/// Kept as published for comparison; no standard deviation is known, all are NaN. The clouds must
/// be levelled: z = 0 is the ground.
///
/// @throws Error (bad_input) if an option is out of range, a cloud has no finite point, or the
/// extent of an area exceeds 2^31 voxels
VolumeChange paper_volumes(const CloudPair& dig, const CloudPair& dump, double leaf,
                           const PaperOptions& options = {});

}  // namespace excavplan
