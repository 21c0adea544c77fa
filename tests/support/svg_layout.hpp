// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "drawing/drawing.hpp"

/// @file
/// Whether the texts of a figure can be read: their size, and that none lies on another.

namespace excavplan::test {

/// A text of an SVG figure, the box that it takes up in a wide font [pt].
struct PlacedText {
  std::string text;
  double size = 0.0;
  Box box;
};

inline std::string attribute_of(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(' ' + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t start = at + name.size() + 3;
  return tag.substr(start, tag.find('"', start) - start);
}

inline std::string without_entities(std::string text) {
  for (const auto& [entity, character] :
       {std::pair("&amp;", "&"), {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}}) {
    for (auto at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1)) {
      text.replace(at, std::string(entity).size(), character);
    }
  }
  return text;
}

inline std::vector<PlacedText> texts_of(const std::string& svg) {
  std::vector<PlacedText> texts;
  for (auto at = svg.find("<text "); at != std::string::npos; at = svg.find("<text ", at + 1)) {
    const std::size_t end = svg.find('>', at);
    const std::string tag = svg.substr(at, end - at);
    PlacedText placed;
    placed.text = without_entities(svg.substr(end + 1, svg.find("</text>", end) - end - 1));
    placed.size = std::stod(attribute_of(tag, "font-size"));
    const bool bold = !attribute_of(tag, "font-weight").empty();
    const double width = text_width(placed.text, placed.size, bold);
    const std::string anchor = attribute_of(tag, "text-anchor");
    const double share = anchor.empty() ? 0.0 : (anchor == "middle" ? 0.5 : 1.0);
    const double x = std::stod(attribute_of(tag, "x"));
    const double y = std::stod(attribute_of(tag, "y"));
    const double up = 0.72 * placed.size;
    const double high = 0.85 * placed.size;  // with what hangs below the base line
    placed.box = attribute_of(tag, "transform").empty()
                     ? Box{x - share * width, y - up, width, high}
                     : Box{x - up, y - (1.0 - share) * width, high, width};
    texts.push_back(placed);
  }
  return texts;
}

inline bool overlap(const Box& a, const Box& b) {
  constexpr double touch = 0.3;  // [pt]
  return a.left + touch < b.right() && b.left + touch < a.right() && a.top + touch < b.bottom() &&
         b.top + touch < a.bottom();
}

/// Every text has at least 6 pt, is on the sheet and on no other text.
inline void expect_legible(const std::string& svg, const std::string& what) {
  const std::string view = attribute_of(svg.substr(0, svg.find('>')), "viewBox");
  char* rest = nullptr;
  const double width = std::strtod(view.c_str() + 4, &rest);
  const double height = std::strtod(rest, nullptr);
  const std::vector<PlacedText> texts = texts_of(svg);
  EXPECT_GT(texts.size(), 3U) << what;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const Box& box = texts[i].box;
    EXPECT_GE(texts[i].size, 6.0) << what << ": " << texts[i].text;
    EXPECT_TRUE(box.left > -0.5 && box.right() < width + 0.5 && box.top > -0.5 &&
                box.bottom() < height + 0.5)
        << what << ": off the sheet: " << texts[i].text;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(overlap(box, texts[j].box))
          << what << ": '" << texts[i].text << "' on '" << texts[j].text << "'";
    }
  }
}

}  // namespace excavplan::test
