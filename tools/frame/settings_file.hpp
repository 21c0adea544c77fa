// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// What a file of settings states.
struct StatedSettings {
  struct Option {
    std::size_t entry = 0;           ///< index of the option
    std::vector<std::string> texts;  ///< as on the command line; empty: a flag that is off
    std::string place;               ///< "site.toml: line 3, column 8: "
  };
  std::vector<Option> options;
  /// Tables of other tools, and keys before all tables that this tool has no option of.
  std::vector<std::string> left_out;
};

/// Reads a file of settings in TOML 1.0 (`docs/formats.md#settings`). Keys are options; those in
/// the table [TOOL] must be of this tool, those before all tables are used if it has them, those in
/// tables of other tools are not looked at. Of one option the table wins. Nothing in it runs code,
/// Arguments::Entry::check_in_file, or names a file to write, Entry::output and Entry::place.
///
/// A list is one value after the other where an option may be repeated, else joined with commas.
/// @throws Error (bad_file) naming file, line, column and rule
StatedSettings read_settings_file(const std::string& path, const std::string& tool,
                                  const std::vector<Arguments::Entry>& entries);

/// The same of a text, which messages call `name`.
StatedSettings parse_settings(const std::string& name, const std::string& text,
                              const std::string& tool,
                              const std::vector<Arguments::Entry>& entries);

}  // namespace excavplan::tools
