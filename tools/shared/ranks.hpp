// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/library/library_build.hpp>

namespace excavplan::tools {

/// The processes that mpirun started, this one among them. All MPI of excavplan is behind it.
class Ranks : public WorkSharing {
 public:
  /// Nothing if this process was not started by an MPI launcher, or was built without MPI.
  static std::unique_ptr<Ranks> started();

  virtual int rank() const = 0;
  /// Ends this process's part with its exit code. One that failed takes the others with it, who
  /// would wait for it. What it has to say of that is printed, "rank 3: " before each line, unless
  /// the first rank fails as well and tells it itself; of several others one speaks.
  virtual void end(int code, const std::string& complaint) = 0;
};

}  // namespace excavplan::tools
