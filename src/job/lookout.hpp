// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/job/job_settings.hpp>

#include "job/job_stations.hpp"
#include "scans/sensor_look.hpp"

/// @file
/// Where the machine stands only to look at what is hidden from where it digs. Private to the
/// project.

namespace excavplan {

/// What is to be seen.
struct LookTask {
  const JobFrame& frame;
  const JobSettings& settings;
  const JobMap& map;
  const Terrain& ground;          ///< as expected
  const Eigen::ArrayXXd& seen;    ///< NaN where the ground is not seen as it is now
  std::vector<SensorLook> looks;  ///< that a scan is made of
  BasePose base;                  ///< where the machine is now
  double may_stay = 0.0;          ///< share of the design that need not be seen
  std::size_t most = 1;           ///< looks that can be made
  /// From where it digs afterwards: what lies within reach of there is seen then, and a look costs
  /// what is driven farther for it.
  std::optional<JobStation> next = {};
};

/// The place beside or before the design from which a scan sees most of what is not seen, less the
/// way there; nothing if it sees hardly any of it from wherever it can stand, or little is hidden.
std::optional<JobStation> best_lookout(const LookTask& task);

}  // namespace excavplan
