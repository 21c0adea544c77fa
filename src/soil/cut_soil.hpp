// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// The ground above a point: loose soil on the bank, each with its own state, mean over the width.
struct CutSoil {
  SoilState bank;
  SoilState loose;
  double bank_depth = 0.0;   ///< down to the point; 0 if it is in the loose layer [m]
  double loose_depth = 0.0;  ///< of the loose layer, down to the point at most [m]

  double depth() const { return bank_depth + loose_depth; }
  /// Vertical stress at the point [Pa].
  double overburden() const {
    return bank.unit_weight * bank_depth + loose.unit_weight * loose_depth;
  }

  /// Mean of what a function gives for a soil over the lowest part, of this thickness.
  template <typename OfSoil>
  double mean_at_point(double thickness, const OfSoil& of_soil) const {
    if (!(bank_depth > 0.0)) return of_soil(loose);
    if (bank_depth >= std::min(thickness, depth())) return of_soil(bank);
    const double share = bank_depth / std::min(thickness, depth());
    return share * of_soil(bank) + (1.0 - share) * of_soil(loose);
  }

  /// Mean over the depth of friction and adhesion on a steel plate, under the pressure at rest
  /// [Pa].
  double plate_friction() const;
};

/// Coefficient of the pressure at rest (Jaky 1944).
double at_rest(const SoilState& soil);

/// Bearing capacity of a strip footing with this stress beside it (Prandtl, Reissner; N_gamma of
/// Vesic 1973) [Pa].
double bearing_capacity(const SoilState& soil, double overburden, double width);

}  // namespace excavplan
