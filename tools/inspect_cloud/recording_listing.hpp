// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace excavplan::tools {

/// What is in a recording; nothing if `text` does not name one alone.
struct RecordingListing {
  nlohmann::ordered_json json;
  std::vector<std::string> lines;
};
std::optional<RecordingListing> recording_listing(const std::string& text);

}  // namespace excavplan::tools
