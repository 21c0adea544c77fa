// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/survey/efficiency.hpp>

#include "shared/scans.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {

/// One dig as given on the command line.
struct RunInputs {
  std::string prefix;  ///< of its options: empty or "second-"
  std::optional<std::string> log;
  std::optional<double> volume;
  std::optional<double> volume_sd;
  std::optional<double> mass;
  std::optional<double> mass_sd;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  std::optional<double> from;
  std::optional<double> to;

  /// Binds the options of the dig, the log apart. `whose` follows their help.
  void declare(Arguments& arguments, const std::string& its_prefix, const std::string& whose);
  /// True if any of these options is given.
  bool any() const;
  /// @throws Error (bad_input) unless the payload is given exactly once
  LoggedDig dig(const ScanFrames& frames) const;

 private:
  std::string option(const std::string& name) const { return "--" + prefix + name; }
  void check() const;
};

}  // namespace excavplan::tools
