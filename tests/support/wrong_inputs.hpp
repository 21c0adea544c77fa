// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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

inline Verdict verdict_of(const std::function<Verdict()>& work) {
  try {
    return work();
  } catch (const Error& error) {
    Verdict refused;
    refused.error = error.what();
    return refused;
  }
}

/// Prints what becomes of each, one a line.
inline void expect_no_wrong_answer(const std::vector<WrongInput>& inputs) {
  for (const WrongInput& input : inputs) {
    const Verdict verdict = verdict_of(input.made);
    std::cout << input.name << " | " << verdict.text() << std::endl;
    const bool is_silent = verdict.trusted && verdict.right && input.may_be_right;
    const bool is_said =
        !verdict.trusted && std::any_of(input.reasons.begin(), input.reasons.end(),
                                        [&](const auto& reason) { return verdict.says(reason); });
    EXPECT_TRUE(is_silent || is_said) << input.name << ": " << verdict.text();
  }
}

}  // namespace excavplan::test
