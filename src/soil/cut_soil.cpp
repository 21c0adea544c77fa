// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "soil/cut_soil.hpp"

#include <cmath>

#include "base/angles.hpp"

namespace excavplan {

namespace {

/// N_q.
double bearing_factor(double friction) {
  const double root = std::tan(0.25 * pi + 0.5 * friction);
  return std::exp(pi * std::tan(friction)) * root * root;
}

double active_pressure(double friction) {
  return (1.0 - std::sin(friction)) / (1.0 + std::sin(friction));
}

}  // namespace

RestingSoil::RestingSoil(const SoilState& state) : SoilState(state), rest(state.friction_angle) {}

LayerSoil::LayerSoil(const SoilState& state)
    : RestingSoil(state),
      tool_tangent(std::tan(state.tool_friction_angle)),
      active(active_pressure(state.friction_angle)),
      blunt_edge(blunt_edge_ratio(0.5 * pi, state.friction_angle, state.tool_friction_angle)),
      bearing(bearing_factor(state.friction_angle)) {}

double CutSoil::plate_friction() const {
  if (!(depth() > 0.0)) return 0.0;
  double sum = 0.0;
  double above = 0.0;
  const auto add = [&](const LayerSoil& soil, double thickness) {
    if (!(thickness > 0.0)) return;
    const double stress = above + 0.5 * soil.unit_weight * thickness;
    above += soil.unit_weight * thickness;
    sum += thickness * (soil.adhesion + soil.rest.pressure * stress * soil.tool_tangent);
  };
  add(loose, loose_depth);
  add(bank, bank_depth);
  return sum / depth();
}

double bearing_capacity(const LayerSoil& soil, double overburden, double width) {
  const double n_q = soil.bearing;
  return soil.cohesion * (n_q - 1.0) / soil.rest.tangent + overburden * n_q +
         soil.unit_weight * width * (n_q + 1.0) * soil.rest.tangent;
}

}  // namespace excavplan
