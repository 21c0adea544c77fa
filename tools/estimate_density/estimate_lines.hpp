// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/density/density_estimate.hpp>

namespace excavplan::tools {

/// An estimate for people.
std::vector<std::string> estimate_lines(const DensityEstimate& estimate);

}  // namespace excavplan::tools
