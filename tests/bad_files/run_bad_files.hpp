// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bad_files/bad_file.hpp"
#include "fuzz/file_readers.hpp"

/// @file Bad files read in processes of their own, and what became of them.

namespace excavplan::test {

/// What became of the bad files of a format.
struct BadFileTally {
  std::string format;
  int files = 0;    ///< that were read
  int refused = 0;  ///< by an Error
  int same = 0;     ///< that say what the valid file says
  int other = 0;    ///< that say something else, and may
  // Findings:
  int crashes = 0;  ///< ended by a signal, or by another exception than Error
  int hangs = 0;
  int garbage = 0;        ///< read, and should be refused, or say something else
  int wrong_refusal = 0;  ///< refused, and is right, or the error names no file
  int slow = 0;           ///< over 1 s of processor time
  int large = 0;          ///< over 4 times the file and 64 MiB of memory
  std::vector<std::string> findings;

  /// What must be 0 everywhere; time and memory are those of the machine too.
  int wrong() const { return crashes + hangs + garbage + wrong_refusal; }
};

/// Reads every n-th of the bad files of a format, each in a process of its own.
BadFileTally run_bad_files(const FileReader& reader, std::size_t every = 1);

/// Cuts the valid files of a format at every n-th byte, and flips a bit of every n-th: all bits of
/// files up to 3 kB, else one.
BadFileTally run_sweeps(const FileReader& reader, std::size_t every = 1);

/// A table of these, and their findings.
std::string report_of(const std::vector<BadFileTally>& tallies);

}  // namespace excavplan::test
