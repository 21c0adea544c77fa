// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/survey/density_estimate.hpp>

#include "shared/arguments.hpp"

namespace excavplan::tools {

/// How volumes are found, as on the command line.
struct MethodInputs {
  std::string method = "surface";
  std::string voxels = "columns";  ///< PaperOptions::voxels
  std::string outliers = "50,1";   ///< neighbours and deviations, or "none"
};

void declare_method(Arguments& arguments, MethodInputs& inputs);

/// Of options that have no effect. @param both  of the methods are shown
std::vector<Warning> warnings_of(const MethodInputs& inputs, bool both);

/// Sets the method and its options. @throws Error (bad_input)
void apply_method(const MethodInputs& inputs, DensityOptions& options);

}  // namespace excavplan::tools
