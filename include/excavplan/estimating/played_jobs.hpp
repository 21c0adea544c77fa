// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace excavplan {

/// A job that was played against hidden truth, over its reference (JobReference).
struct PlayedJob {
  std::string soil;              ///< by its name
  double density_percent = 0.0;  ///< mean of the true one [%]
  double digs = 0.0;             ///< over those of the reference [-]
  double time = 0.0;             ///< likewise, with moves and scans
  double energy = 0.0;           ///< likewise, of cycles and moves
  double work = 0.0;             ///< the same without the idle power of the engine
};

/// Jobs of one kind: upright trenches of one size, by one machine.
struct PlayedJobs {
  std::string machine;          ///< by its name
  double length = 0.0;          ///< [m]
  double width = 0.0;           ///< [m]
  double depth = 0.0;           ///< [m]
  std::vector<PlayedJob> jobs;  ///< at least two
};

/// Reads played jobs (docs/formats.md#played-jobs).
/// @throws Error (bad_file) naming file, key, value and rule
PlayedJobs load_played_jobs(const std::string& path);

}  // namespace excavplan
