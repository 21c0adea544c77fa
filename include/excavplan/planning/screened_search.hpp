// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/dig_search.hpp>

/// @file
/// A search in two fidelities of one simulator (docs/simulators.md#cost).

namespace excavplan {

/// How a search is screened; ours.
struct Screening {
  int cells = 1;        ///< of the ground along x and y in one of the ground searched on, >= 1
  double steps = 4.0;   ///< of the path in one of the paths searched, >= 1
  int confirmed = 190;  ///< digs at most on the ground itself, >= 1
  int candidates = 5;   ///< best digs that lie apart, of which the polish takes up the best, >= 1
};

/// The ground on cells so many times as large: means of what is known; unknown where nothing is.
/// @throws Error (bad_input) if the terrain is none, or `cells` not in 1 .. 8
Terrain coarser(const Terrain& terrain, int cells);

/// A search in coarser steps, or on coarser ground, and from its best digs on a polish in fine
/// steps on the ground itself. Where starts are searched, by MemeticSearch within
/// `stop.evaluations`, the first looks all over the reach, with numbers of its own
/// (docs/methods.md#planning); else it is search_dig(). All figures are those of a
/// dig there; evaluations and ranks are those of both. Where the first finds no feasible dig, or
/// none with a feasible dig near it, search_dig() follows. A checkpoint is of the polish alone;
/// what precedes it is done again.
/// @throws Error as search_dig() and coarser()
Found<DigSearchResult> search_screened(const Machine& machine, const SoilSimulator& simulator,
                                       const Terrain& terrain, const DigSearchOptions& options = {},
                                       const Screening& screening = {});

}  // namespace excavplan
