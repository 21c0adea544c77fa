// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "simulation/soil_wedges.hpp"

#include <algorithm>
#include <utility>

namespace excavplan {

SoilWedges::SoilWedges(SoilKind kind, const SoilState& bank, const SoilState& loose)
    : kind_(std::move(kind)), bank_(bank), loose_(loose) {}

EarthmovingFactors SoilWedges::at(double rake, double slope, const SoilState& soil,
                                  bool on_soil) const {
  for (const Tables* tables : {&bank_, &loose_}) {
    if (soil.friction_angle != tables->friction) continue;
    return (on_soil ? tables->on_soil : tables->on_steel).at(rake, slope);
  }
  std::call_once(uneven_made_, [&] {
    const double densest = kind_.friction_loosest + kind_.friction_gain;
    const auto [low, high] = std::minmax(kind_.friction_loosest, densest);
    uneven_on_steel_.emplace(low, high, kind_.tool_friction_ratio);
    uneven_on_soil_.emplace(low, high, 1.0);
  });
  return (on_soil ? *uneven_on_soil_ : *uneven_on_steel_).at(rake, slope, soil.friction_angle);
}

}  // namespace excavplan
