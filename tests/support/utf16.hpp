// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan::test {

/// A text of ASCII in UTF-16.
inline std::string utf16(const std::string& text, bool big_endian, bool with_mark = true) {
  std::string bytes = with_mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

}  // namespace excavplan::test
