// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/library/path_library.hpp>

/// @file
/// Makes path libraries: on one core, on several, on several machines (docs/methods.md#library).
///
/// A library is made of cells, one for each density on each slope for each machine in each soil. A
/// cell has its own seed, and starts from the digs of two other densities at most, which depend on
/// its density alone. So the outcome of a cell depends on nothing but itself. When all cells of a
/// slope are known, those that their neighbours show to be worse than need be are looked at again
/// (docs/methods.md#a-second-look). A library has the same bytes however its cells are shared out,
/// interrupted and resumed.

namespace excavplan {

/// The cells of a build: all machines with all soils, slopes and densities.
struct LibraryGrid {
  std::vector<Machine> machines;
  std::vector<SoilKind> soils;
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

/// All that decides a cell besides its place in the grid.
struct LibrarySearch {
  /// With a genetic algorithm, as in the paper, every density is searched from nothing.
  std::variant<AnchoredSearch, GeneticAlgorithm> method = AnchoredSearch{};
  double cell_size = 0.05;  ///< of the simulated ground [m]
  std::uint64_t seed = 1;
};

struct LibraryProgress {
  std::size_t cells_done = 0;
  std::size_t cells = 0;  ///< in all; grows as densities are added
  int evaluations = 0;    ///< by this process
  std::string cell;       ///< last one worked on
  double best = 0.0;      ///< efficiency found in it so far [kg/J]; NaN: none yet
  double seconds = 0.0;
  double seconds_left = 0.0;  ///< NaN: unknown yet
};

/// Shares out work among processes that all do the same calls in the same order.
class WorkSharing {
 public:
  virtual ~WorkSharing() = default;
  /// 0, 1, 2 .. over all processes: each number once, until exchange() is called. From any thread.
  virtual std::size_t next() = 0;
  /// Waits for all processes and gives each what all of them brought. The numbers begin anew.
  virtual std::vector<std::string> exchange(const std::string& mine) = 0;
};

struct LibraryBuildOptions {
  LibrarySearch search;
  /// Densities are added midway wherever the look-up there gives away more than this share of the
  /// efficiency, down to 1 % of density between two, and wherever two are more than 10 % apart; 0:
  /// none are.
  double refine = 0.0;
  unsigned threads = 0;  ///< 0: one per core. The result does not depend on it.
  /// Of the cells' files, one each, written whole or not at all; those found here are kept. Empty:
  /// none.
  std::string folder;
  bool only_merge = false;         ///< a cell of the grid that is not in the folder is an error
  WorkSharing* sharing = nullptr;  ///< among processes; nothing: there is one
  /// After every dig, batch of digs and cell, one call at a time, from any thread; false stops.
  std::function<bool(const LibraryProgress&)> progress;
  /// For people: a file in the folder that is not what it should be, and is computed anew. Never
  /// called at once with itself or `progress`, from any thread.
  std::function<void(const std::string&)> note;
};

struct LibraryBuild {
  std::vector<PathLibrary> libraries;  ///< one for each machine and soil; empty if stopped
  bool stopped = false;                ///< by `progress`
  std::size_t cells_done = 0;
  std::size_t cells = 0;
};

/// What build_path_libraries() asks first: for callers that prepare its folder.
/// @throws Error (bad_input) if the grid or an option is out of range
void require_buildable(const LibraryGrid& grid, const LibraryBuildOptions& options);

/// Searches the best dig of every cell with the built-in simulator.
///
/// @throws Error (bad_input) if the grid or an option is out of range, or no dig is feasible for a
///         machine in a soil at all
/// @throws Error (bad_file) if the folder cannot be used, or lacks a cell that is to be merged
LibraryBuild build_path_libraries(const LibraryGrid& grid, const LibraryBuildOptions& options = {});

/// The `index`-th of `count` parts of the cells, index from 1.
struct LibraryShard {
  int index = 1;
  int count = 1;
};

/// Computes one part of the cells into the folder, for build_path_libraries() to merge. Parts need
/// not know of each other.
/// @return no libraries
/// @throws Error as build_path_libraries()
LibraryBuild build_library_shard(const LibraryGrid& grid, const LibraryShard& shard,
                                 const LibraryBuildOptions& options);

}  // namespace excavplan
