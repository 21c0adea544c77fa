// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

/// @file
/// Reads the pages of --report.

namespace excavplan::test {

/// What stands between two texts, the first time; empty if they do not occur.
inline std::string between(const std::string& text, const std::string& open,
                           const std::string& close) {
  const std::size_t found = text.find(open);
  if (found == std::string::npos) return "";
  const std::size_t start = found + open.size();
  return text.substr(start, text.find(close, start) - start);
}

/// What the page draws.
inline nlohmann::json drawn_on(const std::string& page) {
  return nlohmann::json::parse(between(page, "id=\"data\">", "</script>"));
}

/// The JSON at its end as a browser shows it.
inline std::string result_on(const std::string& page) {
  std::string text = between(page, "<pre id=\"result\">", "</pre>");
  for (const auto& [code, sign] : {std::pair<std::string, const char*>("&quot;", "\""),
                                   {"&lt;", "<"},
                                   {"&gt;", ">"},
                                   {"&amp;", "&"}}) {
    for (auto at = text.find(code); at != std::string::npos; at = text.find(code, at + 1)) {
      text.replace(at, code.size(), sign);
    }
  }
  return text;
}

}  // namespace excavplan::test
