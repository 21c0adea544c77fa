// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

/// @file
/// Plots as SVG text: panels with axes in one row or two, then a colour bar, a legend, lines of
/// text and bars.

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
  /// Cells coloured by band_colour(); unknown cells stay grey, "not seen".
  void heat_map(const HeightMap& map, const std::vector<double>& bands);

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
    std::vector<double> bands = {};
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
  std::vector<double> bands;
  std::string label;
  double unit = 1.0;  ///< the numbers on it are values over this
};

/// A bar with its text.
struct Bar {
  std::string text;
  double value = 0.0;  ///< >= 0, drawn relative to the largest
};

struct Figure {
  std::string title;
  std::vector<Panel> panels;
  std::optional<ColourBar> colour_bar;
  std::vector<std::string> notes;  ///< an empty line is a gap
  std::vector<Panel> lower = {};   ///< a second row of panels, of half the height
  std::vector<Bar> bars = {};      ///< below the notes
};

/// The whole file. Equal figures give equal bytes.
std::string to_svg(const Figure& figure);

/// Text with &, <, > and quotes as XML and HTML want them.
std::string xml_escaped(const std::string& text);

/// Colour of a value from -1 to 1: red, white, blue, distinct for colour-blind readers too
/// (ColorBrewer's RdBu, C. Brewer).
std::string diverging_colour(double value);

/// Upper bounds of bands in steps of 1, 2, 5, 10, ... from `least` on, as many as lie below
/// `largest`, but one at least.
std::vector<double> colour_bands(double least, double largest);

/// Colour of a value: white below the first bound, then one of diverging_colour() for each band, so
/// that centimetres show beside decimetres.
std::string band_colour(double value, const std::vector<double>& bands);

}  // namespace excavplan::tools
