// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/density/density_options.hpp>
#include <excavplan/density/density_result.hpp>

/// @file
/// From volumes and what is known beside them to the density.

namespace excavplan {

/// The laws that an estimate uses, all of them for the path that was dug if one can be fitted.
struct LawsForDig {
  DensityLaw law;
  std::vector<SoilLaw> possible;
  std::optional<WorkOverDensity> work;  ///< expected of the joints, if theirs was measured
  std::vector<Warning>
      warnings;  ///< soil_assumed, law_of_other_path, dug_path_doubtful, loads_not_used
};

/// Drops a measured fallback that cannot be that of a dig along the path.
/// @throws Error (bad_input) if the path cannot be driven on level ground and its start is unknown
LawsForDig laws_for_dig(const DensityLaw& law, const DensityOptions& options,
                        std::optional<Fallback>& fallback);

/// Sets density, readings, soils, payload, warnings and trust of an estimate with a bulking factor.
void set_density(DensityEstimate& estimate, const LawsForDig& laws, const DensityOptions& options);

/// The same by the mass of the payload in known ground, where the heap is out of sight. Does
/// nothing without mass, kind of soil, or a hole that was seen.
void set_density_by_solids(DensityEstimate& estimate, const LawsForDig& laws,
                           const DensityOptions& options);

}  // namespace excavplan
