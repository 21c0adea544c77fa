// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/job/job_settings.hpp>
#include <excavplan/scans/scan_surface.hpp>

#include "job/job_stations.hpp"

/// @file
/// Where the machine stands only to look at what is hidden from where it digs. Private to the
/// project.

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

/// What is to be seen.
struct LookTask {
  const JobFrame& frame;
  const JobSettings& settings;
  const JobMap& map;
  const Terrain& ground;          ///< as expected
  const Eigen::ArrayXXd& seen;    ///< NaN where the ground is not seen as it is now
  std::vector<SensorLook> looks;  ///< that a scan is made of
  BasePose base;                  ///< where the machine is now
};

/// The place beside or before the design from which a scan sees most of what is not seen, less the
/// way there; nothing if it sees hardly any of it from wherever it can stand.
std::optional<JobStation> best_lookout(const LookTask& task);

}  // namespace excavplan
