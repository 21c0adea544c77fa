// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/base/warning.hpp>

namespace excavplan {

/// An option or an input with the value that counted.
struct Setting {
  std::string name;
  std::string value;
  bool given = false;  ///< else it is the default
};

/// The run that a page is about.
struct ReportedRun {
  std::string tool;
  std::string version;
  std::string json;  ///< as --json prints it
  std::vector<std::string> lines;
  std::vector<Warning> warnings;
  bool judged = false;  ///< the tool can find its result not trustworthy
  bool trustworthy = true;
  bool stopped_early = false;
  std::vector<Setting> settings;
};

}  // namespace excavplan
