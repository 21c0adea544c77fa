// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/survey_map_names.hpp"

#include "inputs/maps.hpp"

namespace excavplan::tools {

std::vector<MapName> survey_map_names(const std::optional<std::string>& dump) {
  const Arguments::Use has_dump = {[&dump] { return dump.has_value(); },
                                   "the dump area has no scans of its own"};
  std::vector<MapName> names = ground_map_names(5);
  names.push_back({"sd", "standard deviation of the change of a cell"});
  names.push_back({"zones", "1 hole, 2 spill, 3 heap, 4 other, 0 none"});
  const std::size_t own = names.size();
  names.push_back({"dump", "all of the dump area, if it has scans of its own", 5, has_dump});
  for (std::size_t i = 1; i < own; ++i) names.push_back({"dump-" + names[i].name, "", 1, has_dump});
  return names;
}

}  // namespace excavplan::tools
