// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>

namespace excavplan::tools {

/// What the library calls an input in its messages, and the option that sets it.
using OptionNames = std::vector<std::pair<std::string, std::string>>;

/// Of functions that take the size of cells. Not a constant: others are made of it, and the order
/// in which constants of several sources are made is not told.
inline const OptionNames& cell_option() {
  static const OptionNames names = {{"the cell size is", "--cell: the cell size is"},
                                    {"in cells of", "in cells (--cell) of"}};
  return names;
}

/// A message of the library with the names of options.
std::string with_option_names(std::string message, const OptionNames& names);

/// Runs `work`; an error then names the options.
template <typename Work>
auto naming_options(const OptionNames& names, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.kind(), with_option_names(error.what(), names));
  }
}

}  // namespace excavplan::tools
