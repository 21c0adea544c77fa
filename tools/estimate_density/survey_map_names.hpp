// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inputs/maps.hpp"

namespace excavplan::tools {

/// all, before, after, change, sd and zones; likewise of the dump area, dump, dump-before, ...
/// @param dump  its scan, if it has one of its own; asked once all options are read
std::vector<MapName> survey_map_names(const std::optional<std::string>& dump);

}  // namespace excavplan::tools
