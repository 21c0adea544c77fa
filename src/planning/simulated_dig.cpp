// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/simulated_dig.hpp"

#include <utility>

#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/dig_cycle.hpp>

#include "simulation/checked_dig.hpp"

namespace excavplan {
namespace {

PlannedDig figures_of(const DigResult& result, const Machine& machine, const DigPath& path,
                      const CycleOptions& cycle) {
  PlannedDig dig{
      path.parameters,     path.start_x,
      result.payload_mass, result.payload_volume,
      result.energy.total, time_dig_path(machine, path, {}, result.torques).dig_duration()};
  dig.fill = dig.payload_volume / heaped_capacity(machine);
  add_cycle(dig, machine, path, cycle);
  return dig;
}

}  // namespace

std::variant<PlannedDig, DigFailure> dig_of_path(const Machine& machine,
                                                 const SoilSimulator& simulator,
                                                 const Terrain& terrain, const DigPath& path,
                                                 const CycleOptions& cycle) {
  DigOptions options;  // what slides after the bucket is out changes neither load nor energy
  options.settle = false;
  options.worth_alone = true;
  const DigResult result = checked_dig(simulator, machine, terrain, path, options);
  if (result.stall) return DigFailure(*result.stall);
  return figures_of(result, machine, path, cycle);
}

std::variant<SimulatedDig, DigFailure> dig_to_rest(const Machine& machine,
                                                   const SoilSimulator& simulator,
                                                   const Terrain& terrain, const DigPath& path,
                                                   const CycleOptions& cycle) {
  DigResult result = checked_dig(simulator, machine, terrain, path, {});
  if (result.stall) return DigFailure(*result.stall);
  const PlannedDig dig = figures_of(result, machine, path, cycle);
  return SimulatedDig{dig, std::move(result)};
}

void add_cycle(PlannedDig& dig, const Machine& machine, const DigPath& path,
               const CycleOptions& options) {
  const CycleShare total = cycle_of(machine, path, dig, options).value_or(DigCycle{}).total;
  dig.cycle_energy = total.energy;
  dig.cycle_time = total.time;
}

}  // namespace excavplan
