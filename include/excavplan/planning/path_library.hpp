// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <excavplan/machine/machine.hpp>
#include <excavplan/planning/planner.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// The best dig for one density.
struct PathLibraryEntry {
  double density_percent = 0.0;
  PlannedDig dig;
  int evaluations = 0;
};

/// Best digs on level ground, computed beforehand for one machine and one soil.
struct PathLibrary {
  std::string machine;  ///< name of the machine
  std::string soil;     ///< name of the soil
  double cell = 0.0;    ///< of the ground it was computed on [m]
  std::uint64_t seed = 0;
  int population = 0;  ///< of the search
  int generations = 0;
  int polish_evaluations = 0;
  std::vector<PathLibraryEntry> entries;  ///< density rising, at least one

  int evaluations() const;
};

/// Reads a library file (docs/formats.md).
/// @throws Error (bad_file) naming file, key, value and rule
PathLibrary load_path_library(const std::string& path);

/// The text of a library file; the same library gives the same bytes.
std::string to_json(const PathLibrary& library);

/// The dig for a density: parameters and expectations linear between the two entries around it; the
/// nearer of the two where they differ by more than a fifth of a search range, because the optimum
/// has jumped between them.
///
/// @throws Error (bad_input) if the density is outside the densities of the library
PlannedDig look_up(const PathLibrary& library, double density_percent);

struct LibraryBuildOptions {
  DigSearchOptions search;
  double cell = 0.05;  ///< [m]
  /// After each density: entries done and wanted, and the entry; false stops.
  std::function<bool(std::size_t, std::size_t, const PathLibraryEntry&)> progress;
  std::vector<PathLibraryEntry>
      done;  ///< from an earlier run: these densities are not searched again
};

/// Searches the best dig for every density with the built-in simulator on level ground. The first
/// density is searched from nothing; every later one also starts from the dig of the one before.
///
/// @return the library so far if `progress` stopped it
/// @throws Error (bad_input) if the densities are empty, not rising or outside 0 .. 100, or no dig
///         is feasible for one of them
PathLibrary build_path_library(const Machine& machine, const SoilKind& soil,
                               const std::vector<double>& densities_percent,
                               const LibraryBuildOptions& options = {});

}  // namespace excavplan
