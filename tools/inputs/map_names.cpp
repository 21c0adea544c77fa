// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/map_names.hpp"

namespace excavplan::tools {

std::vector<MapName> ground_map_names(std::size_t layers) {
  return {{"all", "all of these layers, not as .asc", layers},
          {"before", "height of the ground before"},
          {"after", "height after"},
          {"change", "height after less before"}};
}

}  // namespace excavplan::tools
