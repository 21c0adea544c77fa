// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include <excavplan/optimisation/search_settings.hpp>
#include <excavplan/planning/dig_goal.hpp>
#include <excavplan/simulation/simulators.hpp>

/// @file
/// The entries that a path library gets, and how their digs are searched.

namespace excavplan {

/// The entries of a build: all machines with all soils, slopes and densities.
struct LibraryGrid {
  std::vector<Machine> machines;          ///< at least one
  std::vector<SoilKind> soils;            ///< at least one
  std::vector<double> slopes = {0.0};     ///< rising away from the machine [rad], in order
  std::vector<double> densities_percent;  ///< rising
};

/// Densities of 0, 50 and 100 % are searched from nothing; all others are polished from the dig of
/// a neighbour, and searched from nothing too if that leads to no dig, or one worse than its
/// neighbours let expect.
struct AnchoredSearch {
  int points = 32;                 ///< of a first generation from nothing
  int basins = 2;                  ///< polished of it
  int polish_evaluations = 45;     ///< of one polish; the best is polished once more
  int inherited_evaluations = 40;  ///< of a density that starts from a neighbour
};

/// All that decides an entry besides its place in the grid.
struct LibrarySearch {
  /// With a genetic algorithm, as in the paper, every density is searched from nothing.
  std::variant<AnchoredSearch, GeneticAlgorithm> method = AnchoredSearch{};
  DigObjective objective = dig_goals().front().goal;  ///< what digs are best for
  double cell_size = 0.05;                            ///< of the simulated ground [m]
  std::uint64_t seed = 1;                             ///< of every search
  SimulatorKind simulator = default_simulator();      ///< that digs
};

}  // namespace excavplan
