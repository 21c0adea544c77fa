// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include <excavplan/soil/soil.hpp>
#include "soil/earthmoving.hpp"

namespace excavplan {

/// Earthmoving factors at the critical failure angle for all states of a soil, bank or loose.
class SoilWedges {
 public:
  SoilWedges(SoilKind kind, const SoilState& bank, const SoilState& loose);

  /// Factors of a wedge that slides on steel, or on soil as strong as itself, in soil of this
  /// state.
  EarthmovingFactors at(double rake, double slope, const SoilState& soil, bool on_soil) const;

 private:
  struct Tables {
    explicit Tables(const SoilState& soil)
        : friction(soil.friction_angle),
          on_steel(soil.friction_angle, soil.tool_friction_angle),
          on_soil(soil.friction_angle, soil.friction_angle) {}
    double friction;  ///< [rad]
    CriticalWedges on_steel;
    CriticalWedges on_soil;
  };
  SoilKind kind_;
  Tables bank_;
  Tables loose_;
  // For ground of uneven density, made when such ground is first met.
  mutable std::once_flag uneven_made_;
  mutable std::optional<FrictionWedges> uneven_on_steel_;
  mutable std::optional<FrictionWedges> uneven_on_soil_;
};

}  // namespace excavplan
