// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <excavplan/job/job_step.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/trial/hidden_site.hpp>

/// @file
/// Plain policies that a planner is compared with. All dig in lanes along the line of the design,
/// from stations that go backwards, and know what any planner knows.

namespace excavplan {

/// How a plain policy works; the numbers are those of its description, else ours.
struct PlainPolicy {
  std::string word;  ///< "operator"
  /// Ours: the paper's path or one searched once, for level ground of the expected density,
  /// unaware of the floor. Else layers down to the floor, and a pass along it at the end.
  enum class Digs { fixed, searched, layers } digs = Digs::layers;  ///< of what kind
  double station = 2.7;                                             ///< between places to stand [m]
  double farthest = 6.2;     ///< of the tip from the swing axis where a station begins [m]
  double layer = 0.25;       ///< [m]
  double after_stall = 0.7;  ///< share of the layer that is tried next [-]
  double lane_share = 0.8;   ///< most of the bucket's width from lane to lane [-]
  double left = 0.06;        ///< mean height over the floor that ends a lane [m]
  int most_digs = 20;        ///< in a lane at a station
  int most_stalls = 6;       ///< likewise
};

/// "operator": two lanes of a trench of 1 m at 0.15 m to both sides, stations 2.7 m apart, layers
/// of 0.25 m along a level drag, a layer 0.7 times as thick after a stall, finishing passes of one
/// drag on the floor. "fixed": the paper's path. "greedy": the path of most mass per energy of the
/// cycle.
const std::vector<PlainPolicy>& plain_policies();

/// @throws Error (bad_input) if the design is not in words
std::unique_ptr<JobPlanner> plain_planner(const PlainPolicy& policy, const SiteBrief& site,
                                          const HeightMap& first_scan, const Machine& machine);

}  // namespace excavplan
