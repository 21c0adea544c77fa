// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <excavplan/planning/library_build.hpp>

namespace excavplan::tools {

/// The processes that mpirun started: rank 0 does what a single process does, the others work for
/// it. Nothing else in excavplan uses MPI.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;

  /// Waits for all ranks. If one has failed or was started with other options, it prints the
  /// reason, with "rank 3: " before each line, and all ranks end.
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

/// Runs the program in every rank. Only rank 0 prints; output of the others is discarded, unless
/// they fail and rank 0 does not. Of several ranks that fail one prints the reason.
int run_ranked(int argc, const char* const* argv, const RankedProgram& program);

}  // namespace excavplan::tools
