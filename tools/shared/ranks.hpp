// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <excavplan/library/library_build.hpp>

namespace excavplan::tools {

/// The processes that mpirun started, this one among them: rank 0 does what a single process would
/// do, and the others work for it. All MPI of excavplan is behind it.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;

  /// Waits for all ranks. Where one has failed or was started with other options, that one says so,
  /// "rank 3: " before each line, and no rank returns from here.
  /// @param threads  that each of the other ranks works with
  virtual void agree(unsigned threads) = 0;

  /// For rank 0: the threads of the others.
  virtual std::vector<LibraryWorker> workers() = 0;
  /// For the others: works until rank 0 ends.
  virtual void serve(const LibraryWorker& worker) = 0;
};

/// What a program does, and its exit code.
/// @param ranks  none if no MPI launcher started it, or it was built without MPI
using RankedProgram = std::function<int(int argc, const char* const* argv, Ranks* ranks)>;

/// Runs the program in every rank. Rank 0 speaks: what the others print is dropped, unless they
/// alone fail. Of several ranks that fail one says why.
int run_ranked(int argc, const char* const* argv, const RankedProgram& program);

}  // namespace excavplan::tools
