// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/planned_dig.hpp>

#include "planning/dig_layout.hpp"
#include "planning/simulated_dig.hpp"
#include "planning/start_rule.hpp"

namespace excavplan {

std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  const StartRule& start) {
  const auto path = path_by(DigLayout(machine, terrain), parameters, start);
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) return DigFailure(*infeasible);
  return dig_of_path(machine, simulator, terrain, std::get<DigPath>(path));
}

}  // namespace excavplan
