// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/dig_search.hpp>

/// @file
/// A search in two fidelities of one simulator (docs/simulators.md#cost).

namespace excavplan {

/// How a search is screened; ours.
struct Screening {
  int cells = 2;       ///< of the ground along x and y in one of the ground searched on, >= 1
  double steps = 2.0;  ///< of the path in one of the paths searched, >= 1
  int confirmed = 90;  ///< digs at most on the ground itself, >= 1
  int candidates = 4;  ///< best digs that lie apart, of which the polish takes up the best, >= 1
};

/// The ground on cells so many times as large: means of what is known; unknown where nothing is.
/// @throws Error (bad_input) if the terrain is none, or `cells` not in 1 .. 8
Terrain coarser(const Terrain& terrain, int cells);

/// search_dig() on coarser ground and in coarser steps, the first third with the start of least
/// work where starts are searched; then, from its best digs on, a polish on the ground itself. All
/// figures are those of a dig there; evaluations and ranks are those of both. Where coarse ground
/// has no feasible dig, or none with a feasible dig near it, it is search_dig(). A checkpoint is of
/// the polish alone; what precedes it is done again.
/// @throws Error as search_dig() and coarser()
Found<DigSearchResult> search_screened(const Machine& machine, const SoilSimulator& simulator,
                                       const Terrain& terrain, const DigSearchOptions& options = {},
                                       const Screening& screening = {});

}  // namespace excavplan
