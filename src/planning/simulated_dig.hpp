// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include <excavplan/planning/dig_outcome.hpp>

namespace excavplan {

/// Digs a path that was laid out.
std::variant<PlannedDig, DigFailure> dig_of_path(const Machine& machine,
                                                 const SoilSimulator& simulator,
                                                 const Terrain& terrain, const DigPath& path,
                                                 const CycleOptions& cycle = {});
/// A dig with all that the simulator says of it.
struct SimulatedDig {
  PlannedDig dig;
  DigResult result;
};
/// The same, with the ground at rest once it is dug.
std::variant<SimulatedDig, DigFailure> dig_to_rest(const Machine& machine,
                                                   const SoilSimulator& simulator,
                                                   const Terrain& terrain, const DigPath& path,
                                                   const CycleOptions& cycle = {});

/// Sets the figures of its cycle.
void add_cycle(PlannedDig& dig, const Machine& machine, const DigPath& path,
               const CycleOptions& options);

}  // namespace excavplan
