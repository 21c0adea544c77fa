// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace excavplan {

/// How far a job has come.
struct JobProgress {
  double design_volume = 0.0;  ///< to be taken out when the job began [m^3]
  double left_volume = 0.0;    ///< still above the design [m^3]
  double rms = 0.0;            ///< of the deviation where it counts, NaN where none is seen [m]
  double p95 = 0.0;            ///< of its absolute value [m]
  double beyond_twice = 0.0;   ///< share of what counts beyond twice the tolerance [-]
  double seen = 0.0;           ///< share of the design that was seen [-]
  bool is_finished = false;    ///< within the tolerance (Deviation), 99 % of it seen
  int digs = 0;                ///< for volume
  int finishing_passes = 0;    ///< among the digs
  int moves = 0;               ///< of the machine
  int scans = 0;               ///< that were taken in
  int stalls = 0;              ///< among the digs
  double payload_mass = 0.0;   ///< lifted in all [kg]
};

}  // namespace excavplan
