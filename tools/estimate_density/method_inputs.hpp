// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/density/density_estimate.hpp>

#include "frame/arguments.hpp"

namespace excavplan::tools {

/// How volumes are found, as on the command line.
struct MethodInputs {
  std::string method = "surface";
  std::string voxels = "columns";  ///< PaperOptions::voxels
  std::string outliers = "50,1";   ///< neighbours and deviations, or "none"
  bool compare = false;            ///< both methods
  std::optional<DigParameters> dug_path;
  std::optional<double> dug_start;

  /// Whether the volumes are found by this method.
  bool uses(const std::string& word) const;
};

void declare_method(Arguments& arguments, MethodInputs& inputs);
/// @throws Error (bad_input) if this program was built without the method
void check_method(const MethodInputs& inputs);
/// --dug-path and --dug-start.
void declare_dug_path(Arguments& arguments, MethodInputs& inputs);

/// Sets the method and its options. @throws Error (bad_input)
void apply_method(const MethodInputs& inputs, const Machine& machine, DensityOptions& options);

/// By the method of the options, or by both to compare them.
BothEstimates estimate(const MethodInputs& inputs, const DigScans& scans, const DensityLaw& law,
                       const DensityOptions& options);

}  // namespace excavplan::tools
