// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/svg_figure.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace excavplan::test {

std::string xml_fault(const std::string& text) {
  Words open;
  std::size_t at = 0;
  while ((at = text.find('<', at)) != std::string::npos) {
    const bool comment = text.compare(at, 4, "<!--") == 0;
    const std::size_t end = comment ? text.find("-->", at) : text.find('>', at);
    if (end == std::string::npos) return "a tag does not end";
    const std::string tag = text.substr(at + 1, end - at - 1);
    at = end;
    if (comment || tag[0] == '?' || tag[0] == '!') continue;
    if (contains(tag, "<") || std::count(tag.begin(), tag.end(), '"') % 2 != 0) return tag;
    const std::string name = tag.substr(0, tag.find_first_of(" \n/", 1));
    if (tag[0] == '/') {
      if (open.empty() || "/" + open.back() != name) return "<" + tag + "> closes nothing";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  for (std::size_t i = text.find('&'); i != std::string::npos; i = text.find('&', i + 1)) {
    const std::size_t end = text.find(';', i);
    if (end == std::string::npos || end - i > 8) return "a bare & at " + std::to_string(i);
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

void expect_figure(const std::string& file, const Words& texts) {
  const std::string svg = content_of(file);
  EXPECT_TRUE(contains(svg.substr(0, 200), "<svg")) << file;
  EXPECT_EQ(xml_fault(svg), "") << file;
  EXPECT_FALSE(contains(svg, "nan\"") || contains(svg, "inf\"")) << file;
  for (const std::string& text : texts) EXPECT_TRUE(contains(svg, text)) << file << ": " << text;
}

}  // namespace excavplan::test
