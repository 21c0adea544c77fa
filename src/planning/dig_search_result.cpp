// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_search_result.hpp>

#include "machine/dig_path_text.hpp"

namespace excavplan {

std::string describe(const NearestDig& nearest) {
  return path_text(nearest.parameters, nearest.start_x) + ": " + nearest.reason;
}

}  // namespace excavplan
