// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/density/density_estimate.hpp>

#include "frame/tool.hpp"
#include "inputs/logged_dig.hpp"

/// @file
/// What the command line says of a second density, to be combined with that of the scans:
/// --payload-mass, --loads, --prior.

namespace excavplan::tools {

struct SecondDensities {
  std::optional<std::string> payload_mass, moisture;
  std::optional<std::string> prior;
  std::optional<double> drift;  ///< [points]
  std::optional<std::string> loads;
  std::optional<double> from, to;  ///< of the dig in the log of the loads [s]
  LogFormat log;

  void declare(Arguments& arguments);
  /// Into the options of an estimate that has its soil and its dug path.
  /// @throws Error (bad_input), (bad_file) naming option or file
  void apply_to(const DensityLaw& law, DensityOptions& options) const;
  /// Of a prior that was used: adds the warning density_from_elsewhere.
  /// @throws Error (bad_file) if it is the result of this very dig
  void check(const DensityEstimate& estimate, Outcome& outcome) const;
};

}  // namespace excavplan::tools
