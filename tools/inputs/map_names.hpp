// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "inputs/maps.hpp"

namespace excavplan::tools {

/// before, after and change, and all of these layers.
std::vector<MapName> ground_map_names(std::size_t layers);

}  // namespace excavplan::tools
