// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/efficiency/efficiency.hpp>

#include "frame/tool.hpp"
#include "inputs/scans.hpp"

namespace excavplan::tools {

/// How a log is written, and the error of its meter.
struct LogFormat {
  std::optional<std::string> time_column, rate_column;
  std::string time_unit, rate_unit;
  std::string delimiter = "auto", decimal = "auto", phases = "auto", meter = "auto";
  double meter_sd = 2.0;  ///< [%]

  void declare(Arguments& arguments);
  void apply_to(DigLogSource& source) const;
  /// Of the reading. @throws Error (bad_input)
  double meter_share() const;
};

/// How the logs of all runs are written and what of them counts.
struct LogInputs {
  LogFormat format;
  std::optional<std::string> idle;
  std::string count = "dig";
  std::string machine = "zx120";
  bool subtracts_idle = false;

  void declare(Arguments& arguments);
  /// Into one run. @throws Error (bad_input)
  void apply_to(LoggedDig& dig) const;
};

/// What an option or a table of runs calls an error of the library's about a log.
extern const OptionNames log_options;

/// A number with a standard deviation, "1.25" or "1.25,0.03"; 0 if there is none.
/// @throws Error (bad_input) naming `what`
Measured parse_measured(const std::string& what, const std::string& text);

/// One dig as given on the command line.
struct RunInputs {
  std::string prefix;  ///< of its options: empty or "second-"
  std::optional<std::string> log;
  std::optional<double> volume, volume_sd, bank_volume, bank_volume_sd, mass, mass_sd;
  std::optional<std::string> dump_before, dump_after, pit_before, pit_after, bucket_before,
      bucket_after, bulking_factor;
  std::optional<double> from, to;

  /// Binds the options of the dig, the log apart. `whose` follows their help.
  void declare(Arguments& arguments, const std::string& its_prefix, const std::string& whose);
  /// True if any of these options is given.
  bool any() const;
  /// True if its content is to be measured in scans.
  bool has_scans() const { return dump_before || pit_before || bucket_before; }
  /// @throws Error (bad_input) unless the payload is given exactly once
  LoggedDig dig(const ScanFrames& frames, const LogInputs& logs) const;

 private:
  std::string option(const std::string& name) const { return "--" + prefix + name; }
  void check() const;
  BucketContent content(const ScanFrames& frames) const;
};

}  // namespace excavplan::tools
