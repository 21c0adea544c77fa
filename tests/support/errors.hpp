// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>

namespace excavplan::test {

inline bool has(const std::vector<Warning>& warnings, const std::string& code) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const Warning& warning) { return code_text(warning.code) == code; });
}

/// The text of the Error of this kind that a call throws; "no error" if it throws none.
template <typename Call>
std::string error_of(const Call& call, ErrorKind kind = ErrorKind::bad_input) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return "no error";
}

/// The same of an error about a file, without the file's name, with which it must begin.
template <typename Call>
std::string error_about(const Call& call, const std::string& file,
                        ErrorKind kind = ErrorKind::bad_file) {
  const std::string text = error_of(call, kind);
  const std::string start = file + ": ";
  if (text.rfind(start, 0) == 0) return text.substr(start.size());
  EXPECT_EQ(text, "no error") << "does not begin with " << start;
  return text;
}

}  // namespace excavplan::test
