// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan::tools {

/// Standard input as a file that can be read from its begin more than once, as clouds are.
class StandardInput {
 public:
  StandardInput() = default;
  ~StandardInput();
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

  /// Copies standard input to a temporary file without a name. @return a path that opens it
  /// @throws Error (bad_input) the second time; (bad_file) if it cannot be read or
  /// written, or is an SQLite file
  std::string path();
  /// A message with "standard input" in place of that path.
  std::string named(std::string message) const;

 private:
  int file_ = -1;
  std::string path_;
};

}  // namespace excavplan::tools
