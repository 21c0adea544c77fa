// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/calibration/calibration.hpp>

namespace excavplan::tools {

/// Where true and measured bulking factors differ most.
std::vector<std::string> difference_lines(const BulkingDifference& difference);

}  // namespace excavplan::tools
