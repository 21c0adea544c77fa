// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "inputs/maps.hpp"

namespace excavplan::tools {

/// all, before, after, change, footprint and path.
std::vector<MapName> plan_map_names();

}  // namespace excavplan::tools
