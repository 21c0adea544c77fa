// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/clouds/sensor_errors.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// Scans whose stated errors are no small part of a tolerance. Private to the project.

namespace excavplan {

/// The deviation of heights that neighbouring points of a scan share, as its sensor is stated to
/// err: the median of them [m]; 0 if no cloud knows its sensor.
double shared_height_sd(const Scan& scan, const SensorErrors& sensor);

/// What a scan shows of the cells of a ground.
struct ScanHeights {
  Eigen::ArrayXXd z;   ///< NaN where it has no returns [m]
  Eigen::ArrayXXd sd;  ///< as stated for the ranges of its returns [m]
};
ScanHeights heights_of(const Scan& scan, const SensorErrors& sensor, const HeightMap& grid);

/// Mean of least variance of what is known and what a scan shows; the scan alone where both differ
/// by more than their errors explain.
/// @param sd  of what is known, and then of the mean; NaN: as that of the scan [m]
void fuse(const ScanHeights& scan, Terrain& ground, Eigen::ArrayXXd& sd);

}  // namespace excavplan
