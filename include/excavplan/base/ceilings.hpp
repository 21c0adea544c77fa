// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// @file
/// Ceilings of what one call takes on, all ours: far above the needs of a dig or a survey, and low
/// enough that a slip in a number is an Error (bad_input) before the work, not hours of it or a
/// full memory.

namespace excavplan {

/// Threads of one call.
inline constexpr unsigned most_threads = 1024;
/// Cells of a height map. A dig on ground of so many takes about 1.2 GB and a minute.
inline constexpr double most_cells = 2e7;
/// Memory that a survey of two scans may need, by its cells and points [byte].
inline constexpr double most_survey_memory = 8e9;
/// Points or pixels of the messages of a recording that make up one scan.
inline constexpr std::uint64_t most_recorded_points = 50000000;
/// Evaluations that one search may plan, hours of digs.
inline constexpr int most_evaluations = 1000000;
/// Densities that the ground is taken to have where its density is uncertain.
inline constexpr int most_possible_densities = 20;
/// Drawn soils of a calibration.
inline constexpr int most_draws = 100000;
/// Densities times slopes, machines and soils of a build of path libraries.
inline constexpr std::uint64_t most_library_entries = 100000;

}  // namespace excavplan
