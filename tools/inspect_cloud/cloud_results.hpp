// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <excavplan/clouds/cloud.hpp>

#include "frame/tool.hpp"

/// @file
/// What is in a cloud, as JSON and as text lines.

namespace excavplan::tools {

nlohmann::ordered_json cloud_json(const CloudSummary& summary);

/// @param file  its name
std::vector<std::string> cloud_lines(const std::string& file, const CloudSummary& summary);

/// Codes no_finite_points and units.
/// @param unit  of its coordinates, as it was said [m]
std::vector<Warning> cloud_warnings(const std::string& file, const CloudSummary& summary,
                                    double unit);

}  // namespace excavplan::tools
