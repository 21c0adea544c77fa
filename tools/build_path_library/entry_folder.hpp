// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan::tools {

/// A folder of library entries that one run uses alone. It is free again when the run ends, in
/// whatever way.
class EntryFolder {
 public:
  /// @param keep  the entries that are there; else they are removed
  /// @throws Error (bad_file) if the folder cannot be made or another run uses it
  EntryFolder(std::string folder, bool keep);
  /// Removes the folder if it is empty, unless keep() was called.
  ~EntryFolder();
  EntryFolder(const EntryFolder&) = delete;
  EntryFolder& operator=(const EntryFolder&) = delete;

  /// Removes the entries.
  void clear();
  /// Leaves the folder for the run that resumes this one, even without entries.
  void keep() { kept_ = true; }

 private:
  void lock();

  const std::string folder_;
  const std::string lock_;  ///< the file whose lock the run holds
  int file_ = -1;
  bool kept_ = false;
};

}  // namespace excavplan::tools
