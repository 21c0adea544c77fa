// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/base/warning.hpp>
#include <excavplan/clouds/cloud.hpp>

/// @file
/// What is in a cloud, for people.

namespace excavplan::tools {

/// @param file  its name
std::vector<std::string> cloud_lines(const std::string& file, const CloudSummary& summary);

/// Codes no_finite_points and units.
/// @param unit  of its coordinates, as it was said [m]
std::vector<Warning> cloud_warnings(const std::string& file, const CloudSummary& summary,
                                    double unit);

}  // namespace excavplan::tools
