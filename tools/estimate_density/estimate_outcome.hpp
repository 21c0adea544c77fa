// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/density_estimate.hpp>

#include "frame/tool.hpp"

/// @file
/// What estimate-density tells of an estimate.

namespace excavplan::tools {

/// The options of what estimate_density() names in its messages.
inline const OptionNames estimate_options = {
    {"path that was dug", "--dug-path"}, {"inside the area", "inside --area"},
    {"cell_size is", "--cell is"},       {"water_content", "--moisture"},
    {"payload_mass", "--payload-mass"},  cell_option().back()};

/// @param soil  what was known of it
Outcome estimate_outcome(const DensityEstimate& estimate, const SoilKnowledge& soil);

/// In what units the scans were read.
struct TakenUnits {
  double coordinates = 1.0;  ///< [m]
  bool in_counts = false;    ///< depths of cameras, a count for 1 mm without being told
};

/// Code many_buckets, for a hole of more than ten heaped buckets of the machine: one dig fills one.
/// The coordinates may be in another unit; no other check can tell feet from metres, 35 times the
/// volume. None where they are known to be (code units). It does not end trust. A pit of many digs
/// is measured as well as that of one, and bulking factor and density have no unit.
/// Depths in counts that were taken for millimetres have code units instead, with their likely
/// unit. And those of unlike_law().
void add_machine_warnings(const DensityEstimate& estimate, const DensityLaw& law,
                          const Machine& machine, const TakenUnits& units, Outcome& outcome);

/// Adds the density as compaction, if there is one. @param proctor  largest dry density [kg/m^3]
void add_compaction(const DensityEstimate& estimate, const SoilKind& soil, double proctor,
                    Outcome& outcome);

/// Adds the result of the other method for the same scans.
void add_comparison(const BothEstimates& both, const DensityEstimate& counts, Outcome& outcome);

}  // namespace excavplan::tools
