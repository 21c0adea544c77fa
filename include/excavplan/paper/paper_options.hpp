// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace excavplan {

/// What the voxel grid of the paper's method leaves one point of.
enum class PaperVoxels {
  columns,  ///< each cell of the base plane, as the paper's sum over a horizontal grid asks for
  cubes,    ///< each cubic voxel: a face is counted once for every voxel that it crosses
};

/// Settings of VolumeMethod::paper beside the edge l of its voxels. The paper says that it removes
/// outliers and not how; the defaults are ours, the usual parameters of PCL's outlier removal.
struct PaperOptions {
  PaperVoxels voxels = PaperVoxels::columns;  ///< what counts once in the sum
  int outlier_neighbours = 50;      ///< of StatisticalOutlierRemoval, >= 0; 0 removes none
  double outlier_deviations = 1.0;  ///< of StatisticalOutlierRemoval [-], > 0
};

}  // namespace excavplan
