// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>

/// @file
/// Inputs of a wrong meaning, and whether what becomes of them can be accepted.

namespace excavplan::test {

/// What became of an input.
struct Verdict {
  bool trusted = false;
  bool right = false;      ///< of an answer: within its error
  std::string error = {};  ///< empty: there is an answer
  std::vector<Warning> warnings = {};

  std::string text() const {
    if (!error.empty()) return "error: " + error;
    std::string text = std::string(right ? "right" : "wrong") + (trusted ? ", trusted" : "");
    for (const Warning& warning : warnings) text += ", " + code_text(warning.code);
    return text;
  }
  /// The error holds it, or it is the code of a warning.
  bool says(const std::string& reason) const {
    return error.find(reason) != std::string::npos ||
           std::any_of(warnings.begin(), warnings.end(),
                       [&](const Warning& warning) { return code_text(warning.code) == reason; });
  }
};

/// A wrong input, and what may be said of it.
struct WrongInput {
  std::string name;
  std::function<Verdict()> made;
  std::vector<std::string> reasons;  ///< a warning's code or a part of an error, any of them
  bool may_be_right = false;         ///< without a word, as it changes nothing that counts
};

Verdict verdict_of(const std::function<Verdict()>& work);

/// Prints what becomes of each, one a line; of every fifth alone, where not all are tried
/// (support/cases.hpp).
void expect_no_wrong_answer(const std::vector<WrongInput>& inputs);

}  // namespace excavplan::test
