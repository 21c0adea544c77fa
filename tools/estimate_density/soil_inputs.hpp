// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/machine/machine.hpp>

#include "frame/arguments.hpp"

/// @file
/// What the command line says of the soil that was dug: --soil and --law.

namespace excavplan::tools {

struct SoilInputs {
  std::optional<std::string> soil;  ///< name, file or "unknown"
  std::string law = "default";
  std::optional<double> proctor = {};  ///< largest dry density [kg/m^3]
};

void declare_soil(Arguments& arguments, SoilInputs& inputs);
void declare_law(Arguments& arguments, SoilInputs& inputs);

/// The law of a file or a shipped one; "default" is that of the built-in simulator in loam.
DensityLaw law_named(const std::string& name);

/// The law for the soil that was said, or for loam, and what else the options hold of it. A soil
/// without a shipped law is dug in the simulator.
/// @throws Error (bad_input) if law and soil are not of one kind, (bad_file)
DensityLaw law_of(const SoilInputs& inputs, const std::string& machine, DensityOptions& options);

}  // namespace excavplan::tools
