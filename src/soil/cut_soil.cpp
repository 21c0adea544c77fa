// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/cut_soil.hpp"

#include <cmath>

#include "base/angles.hpp"

namespace excavplan {

double at_rest(const SoilState& soil) { return 1.0 - std::sin(soil.friction_angle); }

double CutSoil::plate_friction() const {
  if (!(depth() > 0.0)) return 0.0;
  double sum = 0.0;
  double above = 0.0;
  const auto add = [&](const SoilState& soil, double thickness) {
    if (!(thickness > 0.0)) return;
    const double stress = above + 0.5 * soil.unit_weight * thickness;
    above += soil.unit_weight * thickness;
    sum +=
        thickness * (soil.adhesion + at_rest(soil) * stress * std::tan(soil.tool_friction_angle));
  };
  add(loose, loose_depth);
  add(bank, bank_depth);
  return sum / depth();
}

double bearing_capacity(const SoilState& soil, double overburden, double width) {
  const double tangent = std::tan(soil.friction_angle);
  const double root = std::tan(0.25 * pi + 0.5 * soil.friction_angle);
  const double n_q = std::exp(pi * tangent) * root * root;
  return soil.cohesion * (n_q - 1.0) / tangent + overburden * n_q +
         soil.unit_weight * width * (n_q + 1.0) * tangent;
}

}  // namespace excavplan
