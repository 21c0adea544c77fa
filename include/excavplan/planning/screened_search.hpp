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
  int confirmed = 60;  ///< digs at most on the ground itself, >= 1
};

/// The ground on cells so many times as large: means of what is known; unknown where nothing is.
/// @throws Error (bad_input) if the terrain is none, or `cells` not in 1 .. 8
Terrain coarser(const Terrain& terrain, int cells);

/// search_dig() on coarser ground and in coarser steps, and from its best dig on a polish on the
/// ground itself. All figures are those of a dig there; the evaluations are those of both. Where
/// coarse ground has no feasible dig, or one with no feasible dig near it, it is search_dig(). A
/// checkpoint is of the search on coarser ground.
/// @throws Error as search_dig() and coarser()
Found<DigSearchResult> search_screened(const Machine& machine, const SoilSimulator& simulator,
                                       const Terrain& terrain, const DigSearchOptions& options = {},
                                       const Screening& screening = {});

}  // namespace excavplan
