// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/dig_search_options.hpp>
#include <excavplan/planning/dig_search_result.hpp>
#include <excavplan/planning/planned_dig.hpp>

/// @file
/// Search for the best dig in a soil: the path of the highest worth, by default of the highest
/// efficiency f = payload mass / energy.

namespace excavplan {

/// Searches the numbers of a dig for the highest worth. All checks of the path come before the
/// simulation: what cannot be driven costs no evaluation. Its violation, how much of the path is
/// left where it fails, leads the search back to digs that can be driven.
///
/// A dig that the simulator fails at, or answers with a result that no dig can have
/// (SoilSimulator), is an evaluation that failed: it is counted and the search goes on.
///
/// @throws Error (bad_input) if an argument or an option is out of range, the machine does not
/// state
///         what the goal needs, or the first 20 digs all failed (the first reason is quoted)
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered; another
///         simulator is known by its identity()
Found<DigSearchResult> search_dig(const Machine& machine, const SoilSimulator& simulator,
                                  const Terrain& terrain, const DigSearchOptions& options = {});

}  // namespace excavplan
