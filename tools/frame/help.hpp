// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "frame/arguments.hpp"

namespace excavplan::tools {

struct Example {
  std::string command;
  std::string meaning;
};

struct About {
  std::string name;
  std::string summary;  ///< a sentence or a few; wrapped in the help
  std::vector<Example> examples;
  bool can_be_untrustworthy = false;  ///< adds --strict
  bool can_stop_early = false;        ///< an interrupt sets Console::stop_requested() instead
  std::string own_codes = {};         ///< exit codes of its own, "10 finished"
};

/// What --help prints.
std::string help_text(const About& about, const std::vector<Arguments::Entry>& entries);

}  // namespace excavplan::tools
