// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <excavplan/soil/soil.hpp>
#include "soil/earthmoving.hpp"

namespace excavplan {

/// A state of soil, and what forces take of it whatever the depth.
struct RestingSoil : SoilState {
  explicit RestingSoil(const SoilState& state);

  SoilAtRest rest;
};
/// Likewise of what forces on a bucket take.
struct LayerSoil : RestingSoil {
  explicit LayerSoil(const SoilState& state);

  double tool_tangent;  ///< of the tool friction angle
  double active;        ///< coefficient of the active pressure (Rankine)
  double blunt_edge;    ///< blunt_edge_ratio() of an upright edge
  double bearing;       ///< N_q of a footing (Prandtl, Reissner)
};

/// The ground above a point: loose soil on the bank, each with its own state, mean over the width.
struct CutSoil {
  LayerSoil bank;
  LayerSoil loose;
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

/// Bearing capacity of a strip footing with this stress beside it (Prandtl, Reissner; N_gamma of
/// Vesic 1973) [Pa].
double bearing_capacity(const LayerSoil& soil, double overburden, double width);

}  // namespace excavplan
