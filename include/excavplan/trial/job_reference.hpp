// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/simulation/simulators.hpp>
#include <excavplan/trial/hidden_site.hpp>

namespace excavplan {

/// What a job costs at its best, by which a planner's cost is judged: per cubic metre of the
/// design.
///
/// R: the best dig of a full bucket by cycle energy on level ground of the mean true density, with
/// a swing of 22 degrees and the bucket pin 2.0 m high when it dumps; as many of these as the
/// swollen volume of the design takes.
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

/// Settings of job_reference().
struct ReferenceOptions {
  SimulatorKind simulator = default_simulator();
  int evaluations = 600;  ///< of the search; ours
  double full = 0.95;     ///< least share of the heaped capacity of a full bucket; ours
  unsigned threads = 0;   ///< 0: one per core; the same result for any number
};

/// @throws Error (bad_input) as search_dig(); if the machine states no swing or engine
JobReference job_reference(const HiddenSite& site, const Machine& machine,
                           const ReferenceOptions& options = {});

}  // namespace excavplan
