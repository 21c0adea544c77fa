// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

/// @file
/// A page of lines, areas and texts in points (1/72 inch), x right and y down, and its SVG text.

namespace excavplan {

using Points = std::vector<Eigen::Vector2d>;

/// Colours are "#rrggbb"; "none" draws nothing.
struct Style {
  std::string stroke = "#000000";
  double width = 1.0;  ///< [pt]
  std::string fill = "none";
  double opacity = 1.0;
  std::vector<double> dash = {};  ///< lengths of strokes and gaps [pt]
};

/// A part of the page, its upper left corner and its size [pt].
struct Box {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
  bool contains(const Eigen::Vector2d& at, double margin) const {
    return at.x() >= left - margin && at.x() <= right() + margin && at.y() >= top - margin &&
           at.y() <= bottom() + margin;
  }
};

struct DrawnPath {
  std::vector<Points> parts;
  bool closed = false;
  Style style;
};

struct DrawnCircle {
  Eigen::Vector2d centre;
  double radius = 0.0;
  Style style;
};

enum class Anchor { start, middle, end };

struct DrawnText {
  Eigen::Vector2d at;  ///< on the base line
  std::string text;
  double size = 7.0;  ///< of the font [pt]
  Anchor anchor = Anchor::start;
  bool upright = false;  ///< reads from below to above
  bool bold = false;
  bool halo = false;  ///< a white border, for texts on lines and areas
  std::string colour = "#222222";
};

/// Boxes of one colour without borders, the cells of a map.
struct DrawnCells {
  std::string colour;
  std::vector<Box> boxes;
};

/// What follows is drawn inside this box only, until a box of no width.
struct Clip {
  Box box;
};

using DrawnItem = std::variant<DrawnPath, DrawnCircle, DrawnText, DrawnCells, Clip>;

struct Drawing {
  double width = 0.0;   ///< [pt]
  double height = 0.0;  ///< [pt]
  std::string title;    ///< of the file, not drawn
  std::vector<DrawnItem> items;
  std::vector<std::string> left_out = {};  ///< what a given height had no room for
  double needed_height = 0.0;              ///< that has room for all of it [pt]
};

constexpr double points_per_mm = 72.0 / 25.4;

/// Of a text in a wide sans-serif font (DejaVu Sans): in others it is no wider [pt].
double text_width(const std::string& text, double size, bool bold = false);

/// The whole file. Equal drawings give equal bytes.
std::string to_svg(const Drawing& drawing);

/// Text with &, <, > and quotes as XML and HTML want them.
std::string xml_escaped(const std::string& text);

/// A number with so many decimals, without trailing zeros.
std::string short_number(double value, int decimals);

}  // namespace excavplan
