// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/dig_search_result.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Settings of best_full_dig().
struct FullDigOptions {
  SimulatorKind simulator = default_simulator();  ///< that digs
  int evaluations = 600;                          ///< of the search; ours
  double full = 0.95;    ///< least share of the heaped capacity of a full bucket; ours
  unsigned threads = 0;  ///< 0: one per core; the same result for any number
};

/// With this the full dig swings and dumps, as job references say.
struct FullDigCycle {
  double swing = 0.3839724354387525;  ///< 22 degrees [rad]
  double dump_height = 2.0;           ///< of the bucket pin [m]
};

/// The best dig of a full bucket by cycle energy on level ground of one density: what a job costs
/// per bucket at its best.
/// @throws Error (bad_input) as search_dig(); if the machine states no swing or engine
Found<DigSearchResult> best_full_dig(const Machine& machine, const SoilKind& soil,
                                     double density_percent, const FullDigOptions& options = {});

}  // namespace excavplan
