// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/base_pose.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// What the sensors of a machine see of the ground from where it stands. Private to the project.

namespace excavplan {

/// From where, and whither, a machine looks at the ground.
struct SensorLook {
  Eigen::Vector3d from{0, 0, 0};  ///< ahead, to the left, over the ground under the tracks [m]
  double azimuth = 0.0;           ///< of the middle of what it sees, to the left of ahead [rad]
  double half_sector = 0.0;       ///< to either side of it, at most pi [rad]
  double range = 0.0;             ///< in plan [m]
  double steepest = 0.0;          ///< below the horizontal [rad]
};

/// As a scan from there was made: one look of each of its clouds that knows its sensor, nothing of
/// others.
std::vector<SensorLook> looks_of(const Scan& scan, const BasePose& base);
/// Of a sensor on the cab that looks all around.
std::vector<SensorLook> usual_looks();

/// Whether a machine there sees a place over a surface without anything of it in between.
bool sees(const SensorLook& look, const BasePose& base, const HeightMap& surface,
          const Eigen::Vector3d& at);

}  // namespace excavplan
