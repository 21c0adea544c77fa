// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <excavplan/planning/library_search.hpp>
#include <excavplan/planning/path_library.hpp>

/// @file
/// Builds path libraries, on one core or many (docs/methods.md#library).
///
/// A library has an entry for each density on each slope. An entry has a seed of its own, and its
/// search starts from the digs of at most two other densities, which depend on its density alone.
/// Then neighbours are compared, in an order that is fixed. So a library has the same bytes for any
/// number of workers, interrupted and resumed.

namespace excavplan {

/// How far a build is.
struct LibraryProgress {
  std::size_t entries_done = 0;  ///< with their files
  std::size_t entries = 0;       ///< of the whole build
  int evaluations = 0;           ///< by the threads of this process
  double best = 0.0;             ///< last worth told of a search; NaN: none yet
};

/// Does a task of a build: what it is asked and what it answers are texts, which may travel.
using LibraryWorker = std::function<std::string(const std::string& task)>;

/// A worker for the builds of the same grid and search, in this process or another. It may be
/// called from several threads.
/// @throws Error (bad_input) as require_buildable(); from the worker, if the task is none of a
/// build
///         of this grid
LibraryWorker library_worker(LibraryGrid grid, LibrarySearch search);

/// How a build is made.
struct LibraryBuildOptions {
  LibrarySearch search;  ///< of every entry
  unsigned threads = 0;  ///< 0: one per core. The result does not depend on it.
  /// Workers besides the threads, each called from a thread of its own.
  std::vector<LibraryWorker> other_workers;
  /// Of the entries' files, written whole or not at all; those found here are kept, whoever wrote
  /// them. Several builds may use it at once. Empty: none.
  std::string folder;
  /// After every dig, batch of digs and entry, one call at a time, from any thread; false stops.
  std::function<bool(const LibraryProgress&)> progress;
  /// For people: files in the folder that are not used, because they are of other options, or
  /// damaged and computed again. Never called at once with itself or `progress`, from any thread.
  std::function<void(const std::string&)> note;
};

/// What a build has made.
struct LibraryBuild {
  std::vector<PathLibrary> libraries;  ///< one for each machine and soil; empty if stopped
  bool stopped = false;                ///< by `progress`
  std::size_t entries_done = 0;        ///< with their files
  std::size_t entries = 0;  ///< those included that entries start from and the grid lacks
};

/// What build_path_libraries() checks first: for callers that prepare its folder.
/// @throws Error (bad_input) if the grid or an option is out of range, a name is not one line of
///         UTF-8 without control characters, or a machine does not state what the goal needs
void require_buildable(const LibraryGrid& grid, const LibrarySearch& search);

/// Searches the best dig of every entry.
///
/// @throws Error (bad_input) if the grid or an option is out of range, or no dig is feasible for a
///         machine in a soil at all
/// @throws Error (bad_file) if the folder cannot be used
LibraryBuild build_path_libraries(const LibraryGrid& grid, const LibraryBuildOptions& options = {});

/// Removes the entries' files from a folder, and the folder if nothing else is in it.
void remove_library_entries(const std::string& folder);

}  // namespace excavplan
