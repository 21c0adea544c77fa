// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan::tools {

/// "NAME=FILE" or "FILE", as --plot and --map take it: letters and dashes before the first '=' are
/// a name.
struct NamedFile {
  std::string name;  ///< empty: none is given
  std::string file;
};

inline NamedFile named_file(const std::string& text) {
  const std::size_t end =
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-");
  if (end == std::string::npos || end == 0 || text[end] != '=') return {"", text};
  return {text.substr(0, end), text.substr(end + 1)};
}

}  // namespace excavplan::tools
