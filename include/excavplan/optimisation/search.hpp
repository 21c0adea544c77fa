// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/optimisation/search_problem.hpp>
#include <excavplan/optimisation/search_result.hpp>

/// @file
/// The best point of a box under any objective, with few evaluations (docs/methods.md#search).

namespace excavplan {

/// Maximises the objective.
///
/// The same bytes for any number of threads and any order in which evaluations end, and for a
/// search that was interrupted and resumed any number of times (a stop by `seconds` excepted):
/// the draws are keyed by seed, generation and individual, and a resumed search is replayed with
/// the outcomes of the checkpoint, of which it evaluates the best again. Stop rules, threads and
/// given points may be other ones when it is resumed.
///
/// @throws Error (bad_input) if an option or the box is out of range, or if the first 20
///         evaluations all failed, or all of a search that ends with fewer without being cancelled
///         or out of time (the first reason is quoted)
/// @throws Error (bad_file) if a checkpoint is of another search, truncated or altered, or its best
///         outcome is another one now
SearchResult search(const SearchProblem& problem, const SearchOptions& options = {});

}  // namespace excavplan
