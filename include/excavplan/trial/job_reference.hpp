// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/full_dig.hpp>
#include <excavplan/trial/hidden_site.hpp>

namespace excavplan {

/// What a job costs at its best, by which a planner's cost is judged: per cubic metre of the
/// design.
///
/// R: best_full_dig() in soil of the mean true density; as many of these as the swollen volume of
/// the design takes.
///
/// B: of each load the rupture of its soil by a wedge of the rake of the lip without weight or
/// friction of the tool, the lift of soil and links from the middle of the cut over the windrow or
/// the truck, and both swings of 22 degrees; as many loads as the swollen volume is heaped buckets.
/// No strict bound: a front that falls gives nothing back.
struct JobReference {
  double density_percent = 0.0;  ///< mean of the true one over the design [%]
  double design_cut = 0.0;       ///< [m^3]
  double swollen = 0.0;          ///< the same as it lies loose [m^3]
  double energy = 0.0;           ///< R [J/m^3]; NaN if no dig is feasible
  double time = 0.0;             ///< of those digs [s/m^3]; likewise
  double digs = 0.0;             ///< as many
  PlannedDig dig;                ///< the best one
  double bound = 0.0;            ///< B [J/m^3]
  double least_loads = 0.0;      ///< heaped buckets
};

/// @throws Error (bad_input) as best_full_dig()
JobReference job_reference(const HiddenSite& site, const Machine& machine,
                           const FullDigOptions& options = {});

}  // namespace excavplan
