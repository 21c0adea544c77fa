// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>

/// @file
/// Enumerators as the words that the tools and files have for them.

namespace excavplan::python {

/// What `word` gives for each item.
template <typename Items, typename Word>
std::vector<std::string> texts(const Items& items, const Word& word) {
  std::vector<std::string> all;
  for (const auto& item : items) all.emplace_back(word(item));
  return all;
}

/// The enumerator of a word. @throws Error (bad_input) naming the words there are
template <typename Value>
Value of_word(const std::string& what, const std::string& word,
              std::initializer_list<std::pair<const char*, Value>> words) {
  std::string known;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw Error(ErrorKind::bad_input, what + ": '" + word + "' is none of " + known);
}

}  // namespace excavplan::python
