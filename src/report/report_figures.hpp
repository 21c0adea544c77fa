// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace excavplan {

/// Every number of a result in tables, with its unit, standard deviation and interval.
std::string figure_tables(const nlohmann::ordered_json& result);

/// Those of the keys that the result has, as tiles.
std::string headline_tiles(const nlohmann::ordered_json& result,
                           const std::vector<std::string>& keys);

}  // namespace excavplan
