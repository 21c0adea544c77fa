// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/planning/genetic.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// Which dig suits the soil: the path of the highest efficiency f = payload mass / energy.

namespace excavplan {

/// A dig with what it is expected to lift and to cost.
struct PlannedDig {
  DigParameters parameters;
  double start_x = 0.0;         ///< [m]
  double payload_mass = 0.0;    ///< moist [kg]
  double payload_volume = 0.0;  ///< loose [m^3]
  double energy = 0.0;          ///< [J]
  double duration = 0.0;        ///< of penetrate, drag and scoop [s]

  double efficiency() const { return energy > 0.0 ? payload_mass / energy : 0.0; }  ///< [kg/J]
};

/// Why a dig cannot be done: the path cannot be driven, or the machine stalls in the soil.
using DigFailure = std::variant<Infeasible, Stall>;
std::string describe(const DigFailure& failure);

/// Ground that matters for a dig: from near the tracks to the machine's reach, one bucket and its
/// windrows wide on both sides of the boom plane.
Rectangle planning_extent(const Machine& machine);

/// planning_extent() as level ground.
Terrain level_planning_ground(const Machine& machine, double cell = 0.05);

/// Height of a surface in the boom plane, for make_dig_path(). The profile keeps a copy of the row
/// of cells it needs.
GroundProfile boom_plane_profile(const HeightMap& surface);
GroundProfile boom_plane_profile(const Terrain& terrain);  ///< of its surface

/// Lays out a dig, simulates it, times it.
///
/// `start_x` is chosen by make_dig_path_anywhere() if absent. Ground of unknown height under the
/// bucket makes the path infeasible (unknown_ground).
std::variant<PlannedDig, DigFailure> evaluate_dig(const Machine& machine,
                                                  const SoilSimulator& simulator,
                                                  const Terrain& terrain,
                                                  const DigParameters& parameters,
                                                  std::optional<double> start_x = {});

struct DigSearchOptions {
  std::variant<MemeticSearch, GeneticAlgorithm> method = MemeticSearch{};
  StopRules stop;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: one per core. The result does not depend on it.
  std::function<bool(const SearchProgress&)> progress;  ///< after every dig; false stops
  std::vector<DigParameters> start;                     ///< digs to begin with
};

struct DigSearchResult {
  PlannedDig dig;
  int evaluations = 0;
  int infeasible = 0;
  bool stopped = false;
};

/// Searches the three numbers of a dig for the highest efficiency, inside dig_parameter_table().
///
/// @return nothing if no dig was feasible
/// @throws Error (bad_input) if an option is out of range
std::optional<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                          const Terrain& terrain,
                                          const DigSearchOptions& options = {});

}  // namespace excavplan
