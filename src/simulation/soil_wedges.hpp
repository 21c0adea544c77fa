// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include <excavplan/soil/soil.hpp>
#include "simulation/earthmoving.hpp"

namespace excavplan {

/// Earthmoving factors at the critical failure angle for all states of a soil's bank.
class SoilWedges {
 public:
  SoilWedges(SoilKind kind, const SoilState& bank);

  /// Factors of a wedge that slides on steel, or on soil as strong as itself, in soil of this
  /// state.
  EarthmovingFactors at(double rake, double slope, const SoilState& soil, bool on_soil) const;

 private:
  SoilKind kind_;
  double friction_;  ///< of the bank [rad]
  CriticalWedges on_steel_;
  CriticalWedges on_soil_;
  // Tables for ground of uneven density, made when such ground is first met.
  mutable std::once_flag uneven_made_;
  mutable std::optional<FrictionWedges> uneven_on_steel_;
  mutable std::optional<FrictionWedges> uneven_on_soil_;
};

}  // namespace excavplan
