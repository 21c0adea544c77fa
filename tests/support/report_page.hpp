// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

/// @file
/// Reads the pages of --report.

namespace excavplan::test {

/// What stands between two texts, the first time; empty if they do not occur.
std::string between(const std::string& text, const std::string& open, const std::string& close);

/// What the page draws.
nlohmann::json drawn_on(const std::string& page);

/// The JSON at its end as a browser shows it.
std::string result_on(const std::string& page);

}  // namespace excavplan::test
