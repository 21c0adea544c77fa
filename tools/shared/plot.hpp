// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

/// @file
/// Plots as SVG text: panels with axes in a row, then a colour bar, a legend and lines of text.

namespace excavplan::tools {

using Points = std::vector<Eigen::Vector2d>;

/// Colours are SVG colours; "none" draws nothing.
struct Style {
  std::string stroke = "#000000";
  double width = 1.5;  ///< [px]
  std::string fill = "none";
  double opacity = 1.0;
  std::string dash = {};  ///< SVG dash pattern, "6 4"
};

/// One pair of axes and what is drawn in it, in this order.
class Panel {
 public:
  Panel(std::string title, std::string x_label, std::string y_label);

  /// A legend text of "" gives no entry; equal entries appear once.
  void line(const Points& points, const Style& style, const std::string& legend = "");
  void polygon(const Points& points, const Style& style, const std::string& legend = "");
  /// Separate strokes from points 0 to 1, 2 to 3, ...
  void strokes(const Points& ends, const Style& style, const std::string& legend = "");
  void marker(const Eigen::Vector2d& at, const std::string& colour, const std::string& legend = "");
  /// Text centred at a point; moved up or down where it would cover another label.
  void label(const Eigen::Vector2d& at, const std::string& text);
  /// Cells coloured from -limit to limit; unknown cells stay grey, "not seen".
  void heat_map(const HeightMap& map, double limit);

  /// What the axes show; else all that is drawn.
  void view(const Rectangle& view) { view_ = view; }
  /// One metre is as long in x as in y.
  void equal_aspect(bool equal) { equal_aspect_ = equal; }

 private:
  friend class SvgWriter;
  enum class Kind { line, polygon, strokes, marker, label, heat_map };
  struct Shape {
    Kind kind;
    Points points;
    Style style;
    std::string text;  ///< of the legend, or the label
    HeightMap map = {};
    double limit = 0.0;
  };
  Rectangle shown() const;

  std::string title_;
  std::string x_label_;
  std::string y_label_;
  std::vector<Shape> shapes_;
  std::optional<Rectangle> view_;
  bool equal_aspect_ = true;
};

/// The colour scale of heat_map().
struct ColourBar {
  double limit = 1.0;
  std::string label;
};

struct Figure {
  std::string title;
  std::vector<Panel> panels;
  std::optional<ColourBar> colour_bar;
  std::vector<std::string> notes;  ///< an empty line is a gap
};

/// The whole file. Equal figures give equal bytes.
std::string to_svg(const Figure& figure);

/// Text with &, <, > and quotes as XML and HTML want them.
std::string xml_escaped(const std::string& text);

/// Colour of a value from -1 to 1: red, white, blue, distinct for colour-blind readers too
/// (ColorBrewer's RdBu, C. Brewer).
std::string diverging_colour(double value);

/// The smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below the value.
double round_up(double value);

}  // namespace excavplan::tools
