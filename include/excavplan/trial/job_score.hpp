// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/trial/hidden_site.hpp>

namespace excavplan {

/// How a job left the ground, cell by cell of the true ground (docs/methods.md#simulated-jobs).
///
/// Footprint: where the design lies below the ground before. Zone: the footprint without its rim
/// (JobDesign::edge_margin) and without faces steeper than 60 degrees and what is as near to them.
struct JobScore {
  bool finished = false;  ///< p95 <= tolerance, beyond_twice <= 1 %, seen >= 99 %, keep_out <= 10 l
  double rms = 0.0;       ///< of ground after less design, in the zone [m]
  double p95 = 0.0;       ///< of its absolute value [m]
  double beyond_twice = 0.0;    ///< share of the zone beyond twice the tolerance [-]
  double seen = 0.0;            ///< share of the footprint, TrueSite::seen_share() [-]
  double design_cut = 0.0;      ///< in the footprint [m^3]
  double left = 0.0;            ///< of it, still there [m^3]
  double overdig_inside = 0.0;  ///< below the design in the footprint [m^3]
  double overdig_beside = 0.0;  ///< by which ground fell outside of the footprint [m^3]
  double risen = 0.0;           ///< by which ground rose [m^3]
  double spilled = 0.0;         ///< of it, outside of the dump areas [m^3]
  double removed = 0.0;         ///< by which ground fell [m^3]
  double keep_out = 0.0;        ///< volume that changed in the keep-out [m^3]
  bool by_truck = false;        ///< no dump area: spill counts against what was removed

  double left_percent() const;     ///< of the design cut
  double overdig_percent() const;  ///< inside and beside, of the design cut
  double spill_percent() const;    ///< of what rose; by_truck: of what was removed
};

/// @param after  on the grid of the site's ground, which is the ground before
/// @param seen  share of the footprint that was seen [-]
/// @throws Error (bad_input) if it is not on that grid, or the design lies beside the ground
JobScore score_job(const HiddenSite& site, const HeightMap& after, double seen);

/// The footprint of the design on the cells of the true ground at the start: its height, NaN
/// outside [m].
HeightMap footprint_of(const HiddenSite& site);

/// Mean of the true density over what the design takes out [%].
double mean_density(const HiddenSite& site);

}  // namespace excavplan
