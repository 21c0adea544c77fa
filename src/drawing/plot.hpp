// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

#include "drawing/colours.hpp"
#include "drawing/drawing.hpp"

/// @file
/// Plots: panels with axes in rows, a colour bar, a legend and a table, laid out for a sheet.

namespace excavplan {

/// Values on a grid of cells; unknown ones are NaN.
struct Grid {
  Eigen::Vector2d origin = {0.0, 0.0};  ///< corner of the first cell
  Eigen::Vector2d cell = {1.0, 1.0};    ///< size of each
  Eigen::ArrayXXd z;                    ///< rows along y
};

/// One pair of axes and what is drawn in it, in this order. A legend text of "" gives no entry;
/// equal entries of a figure appear once.
class Panel {
 public:
  /// A number on an axis, or a word in its place.
  using Tick = std::pair<double, std::string>;
  enum class Kind { line, polygon, strokes, dots, interval, label, remark, map, span };
  struct Shape {
    Kind kind;
    Points points;
    Style style;
    std::string text;  ///< of the legend, or the label
    double radius = 0.0;
    Grid grid = {};
    ColourScale scale = {};
  };

  Panel(std::string title, std::string x_label, std::string y_label);

  void line(const Points& points, const Style& style, const std::string& legend = "");
  void polygon(const Points& points, const Style& style, const std::string& legend = "");
  /// Separate strokes from points 0 to 1, 2 to 3, ...
  void strokes(const Points& ends, const Style& style, const std::string& legend = "");
  /// @param radius  [pt]
  void dots(const Points& at, double radius, const Style& style, const std::string& legend = "");
  /// A line with a short bar at either end.
  void interval(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Style& style,
                const std::string& legend = "");
  /// Text centred at a point; where it would cover a line or another label beside it, tied to the
  /// point by a thin line.
  void label(const Eigen::Vector2d& at, const std::string& text);
  /// Text above a point; upright where it would be wider than this part of the x axis.
  void remark(const Eigen::Vector2d& at, double width, const std::string& text);
  /// Coloured cells; unknown ones stay grey, `unknown` in the legend; with "" nothing is drawn
  /// there.
  void map(const Grid& grid, const ColourScale& scale, const std::string& unknown = "not seen");
  /// A strip along the upper border, from and to an x.
  void span(double from, double to, const std::string& colour, const std::string& legend);

  /// What the axes show; else all that is drawn.
  void view(const Rectangle& view) { view_ = view; }
  /// A metre is as long in x as in y.
  void equal_aspect() { equal_aspect_ = true; }
  /// The title ends in how many times longer a metre is in y than in x.
  void state_exaggeration() { states_exaggeration_ = true; }
  /// Height over width of the axes, unless equal_aspect().
  void shape(double height_over_width) { shape_ = height_over_width; }
  /// Of the axes [pt], also if that is much.
  void least_height(double height) { least_height_ = height; }
  /// These instead of numbers; words of y take several lines where they find no room.
  void x_ticks(std::vector<Tick> ticks) { x_ticks_ = std::move(ticks); }
  void y_ticks(std::vector<Tick> ticks) { y_ticks_ = std::move(ticks); }
  /// Words of x that find no room are left out, not cut.
  void skip_x_ticks() { skips_x_ticks_ = true; }
  /// The numbers of x are those of -x: it grows to the left.
  void mirror_x() { mirrors_x_ = true; }
  /// Without numbers and name of x unless it is the lowest, above a panel of the same x.
  void hide_x() { hides_x_ = true; }

  const std::string& title() const { return title_; }
  const std::string& x_label() const { return x_label_; }
  const std::string& y_label() const { return y_label_; }
  const std::vector<Shape>& shapes() const { return shapes_; }
  const std::optional<std::vector<Tick>>& x_ticks() const { return x_ticks_; }
  const std::optional<std::vector<Tick>>& y_ticks() const { return y_ticks_; }
  bool has_equal_aspect() const { return equal_aspect_; }
  bool states_exaggeration() const { return states_exaggeration_; }
  bool has_map() const;
  bool hides_x() const { return hides_x_; }
  bool skips_x_ticks() const { return skips_x_ticks_; }
  bool mirrors_x() const { return mirrors_x_; }
  double shape() const { return shape_; }
  double least_height() const { return least_height_; }
  /// The view, or all shapes with a small margin; never empty.
  Rectangle shown() const;

 private:
  std::string title_, x_label_, y_label_;
  std::vector<Shape> shapes_;
  std::optional<Rectangle> view_;
  std::optional<std::vector<Tick>> x_ticks_, y_ticks_;
  bool equal_aspect_ = false;
  bool states_exaggeration_ = false;
  bool hides_x_ = false;
  bool skips_x_ticks_ = false;
  bool mirrors_x_ = false;
  double shape_ = 0.6;
  double least_height_ = 40.0;
};

/// The colour scale of the maps.
struct ColourBar {
  ColourScale scale;
  std::string label;
  double unit = 1.0;  ///< the numbers on it are values over this
};

struct Figure {
  std::string title;  ///< of the file; drawn above a table only
  /// Panels of a row stand side by side where each is at least 50 mm wide, else below one another.
  std::vector<std::vector<Panel>> rows;
  std::optional<ColourBar> colour_bar = {};
  std::string note = {};                ///< a sentence below the legend
  std::vector<std::string> table = {};  ///< lines below all; an empty one is a gap
};

/// Of a sheet that figures are laid out for [mm].
struct SheetSize {
  double width = 170.0;
  std::optional<double> height = {};  ///< else as the figure needs
};

/// Texts have at least 6 pt; on sheets wider than 170 mm all grows with them. In a given height the
/// panels become lower, and the last, then the legend, are left out where they do not fit; the
/// drawing says which.
Drawing lay_out(const Figure& figure, const SheetSize& size = {});

}  // namespace excavplan
