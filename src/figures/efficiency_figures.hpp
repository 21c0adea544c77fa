// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "drawing/plot.hpp"
#include "results/efficiency_results.hpp"

/// @file
/// Figures of one run or two, or of two sets.

namespace excavplan {

struct DrawnRuns {
  const std::vector<DigEfficiency>& runs;
  bool own_meters = false;  ///< as efficiency_gain() takes it
};

/// Efficiency of each run with its 95 % interval.
Figure runs_figure(const DrawnRuns& drawn);
/// Fuel flow or power over time, with the dig and idling.
Figure rates_figure(const DrawnRuns& drawn);
/// Every run of both sets, their means and the gain.
Figure sets_figure(const ComparedSets& sets);

}  // namespace excavplan
