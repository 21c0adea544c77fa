// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_map_names.hpp"

#include "inputs/map_names.hpp"

namespace excavplan::tools {

std::vector<MapName> plan_map_names() {
  std::vector<MapName> names = ground_map_names(4);
  names.push_back({"footprint", "1 where the dig lowers the ground"});
  names.push_back({"path", "path of the tip and outline of the cut, as .dxf or .ply", 0});
  return names;
}

}  // namespace excavplan::tools
