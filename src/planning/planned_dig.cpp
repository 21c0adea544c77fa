// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/planned_dig.hpp>

#include <cmath>
#include <string>

#include "base/text.hpp"
#include "planning/dig_layout.hpp"

namespace excavplan {

std::string describe(const DigFailure& failure) {
  if (const auto* infeasible = std::get_if<Infeasible>(&failure)) return infeasible->message;
  const auto& stall = std::get<Stall>(failure);
  return std::string("the ") + name(stall.joint) + " stalls in the phase " + name(stall.phase) +
         " after " + decimals(stall.travelled, 3) + " m: the required torque is " +
         decimals(std::abs(stall.torque) / 1000.0, 1) + " kN m";
}

std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  const StartRule& start) {
  const auto path = DigLayout(machine, terrain).path(parameters, start);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) return DigFailure(*infeasible);
  return dig_along(machine, simulator, terrain, std::get<DigPath>(path));
}

}  // namespace excavplan
