// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/soil_wedges.hpp"

#include <algorithm>
#include <utility>

namespace excavplan {

SoilWedges::SoilWedges(SoilKind kind, const SoilState& bank)
    : kind_(std::move(kind)),
      friction_(bank.friction_angle),
      on_steel_(bank.friction_angle, bank.tool_friction_angle),
      on_soil_(bank.friction_angle, bank.friction_angle) {}

EarthmovingFactors SoilWedges::at(double rake, double slope, const SoilState& soil,
                                  bool on_soil) const {
  if (soil.friction_angle == friction_) return (on_soil ? on_soil_ : on_steel_).at(rake, slope);
  std::call_once(uneven_made_, [&] {
    const double densest = kind_.friction_loosest + kind_.friction_gain;
    const auto [low, high] = std::minmax(kind_.friction_loosest, densest);
    uneven_on_steel_.emplace(low, high, kind_.tool_friction_ratio);
    uneven_on_soil_.emplace(low, high, 1.0);
  });
  return (on_soil ? *uneven_on_soil_ : *uneven_on_steel_).at(rake, slope, soil.friction_angle);
}

}  // namespace excavplan
