// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/report_page.hpp"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace excavplan::test {

std::string between(const std::string& text, const std::string& open, const std::string& close) {
  const std::size_t found = text.find(open);
  if (found == std::string::npos) return "";
  const std::size_t start = found + open.size();
  return text.substr(start, text.find(close, start) - start);
}

nlohmann::json drawn_on(const std::string& page) {
  return nlohmann::json::parse(between(page, "id=\"data\">", "</script>"));
}

std::string result_on(const std::string& page) {
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
