// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "base/angles.hpp"
#include "base/non_finite.hpp"
#include "base/text.hpp"

namespace excavplan {

// ---- Panel ------------------------------------------------------------------------------------

Panel::Panel(std::string title, std::string x_label, std::string y_label)
    : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)) {}

void Panel::line(const Points& points, const Style& style, const std::string& legend) {
  shapes_.push_back({Kind::line, points, style, legend});
}

void Panel::polygon(const Points& points, const Style& style, const std::string& legend) {
  shapes_.push_back({Kind::polygon, points, style, legend});
}

void Panel::strokes(const Points& ends, const Style& style, const std::string& legend) {
  shapes_.push_back({Kind::strokes, ends, style, legend});
}

void Panel::dots(const Points& at, double radius, const Style& style, const std::string& legend) {
  shapes_.push_back({Kind::dots, at, style, legend, radius});
}

void Panel::interval(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Style& style,
                     const std::string& legend) {
  shapes_.push_back({Kind::interval, {low, high}, style, legend});
}

void Panel::label(const Eigen::Vector2d& at, const std::string& text) {
  shapes_.push_back({Kind::label, {at}, {}, text});
}

void Panel::remark(const Eigen::Vector2d& at, double width, const std::string& text) {
  shapes_.push_back({Kind::remark, {at, {at.x() + width, at.y()}}, {}, text});
}

void Panel::map(const Grid& grid, const ColourScale& scale, const std::string& unknown) {
  const Eigen::Vector2d end(grid.origin.x() + grid.cell.x() * static_cast<double>(grid.z.cols()),
                            grid.origin.y() + grid.cell.y() * static_cast<double>(grid.z.rows()));
  shapes_.push_back({Kind::map,
                     {grid.origin, end},
                     {"#888888", 0.5, unknown.empty() ? "none" : "#c8c8c8"},
                     grid.z.isFinite().all() ? "" : unknown,
                     0.0,
                     grid,
                     scale});
}

void Panel::span(double from, double to, const std::string& colour, const std::string& legend) {
  // Of y: no part of the view.
  shapes_.push_back({Kind::span, {{from, nan}, {to, nan}}, {"none", 0.0, colour}, legend});
}

bool Panel::has_map() const {
  return std::any_of(shapes_.begin(), shapes_.end(),
                     [](const Shape& shape) { return shape.kind == Kind::map; });
}

Rectangle Panel::shown() const {
  Rectangle all = view_.value_or(Rectangle{});
  if (!view_) {
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;
    for (const Shape& shape : shapes_) {
      for (const Eigen::Vector2d& point : shape.points) {
        if (!point.allFinite()) continue;
        low = low.min(point.array());
        high = high.max(point.array());
      }
    }
    if (!(low <= high).all()) return {0.0, 0.0, 1.0, 1.0};
    const Eigen::Array2d margin = (has_map() ? 0.0 : 0.04) * (high - low);
    all = {low.x() - margin.x(), low.y() - margin.y(), high.x() + margin.x(),
           high.y() + margin.y()};
  }
  const auto widen = [](double& low, double& high) {
    const double least = std::max(1e-6, 1e-9 * std::max(std::abs(low), std::abs(high)));
    if (high - low >= least) return;
    const double middle = 0.5 * (low + high);
    low = middle - 0.5 * std::max(least, 0.1 * std::abs(middle));
    high = middle + 0.5 * std::max(least, 0.1 * std::abs(middle));
  };
  widen(all.x_min, all.x_max);
  widen(all.y_min, all.y_max);
  return all;
}

namespace {

using Tick = Panel::Tick;

// ---- Ticks ------------------------------------------------------------------------------------

/// Multiples of 1, 2 or 5 times a power of ten, at most about `wanted` of them.
std::vector<Tick> nice_ticks(double low, double high, double wanted) {
  const double rough = (high - low) / std::max(1.0, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  const int places = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    std::string text = decimals(std::abs(i * step), places);
    if (i < 0.0) text = "−" + text;
    ticks.emplace_back(i == 0.0 ? 0.0 : i * step, text);
  }
  return ticks;
}

double widest(const std::vector<Tick>& ticks, double size) {
  double width = 0.0;
  for (const Tick& tick : ticks) width = std::max(width, text_width(tick.second, size));
  return width;
}

/// Numbers of an x that may grow to the left.
std::vector<Tick> nice_x_ticks(const Panel& panel, const Rectangle& view, double wanted) {
  if (!panel.mirrors_x()) return nice_ticks(view.x_min, view.x_max, wanted);
  std::vector<Tick> ticks = nice_ticks(-view.x_max, -view.x_min, wanted);
  for (Tick& tick : ticks) tick.first = -tick.first;
  return ticks;
}

/// Numbers of x with room between them.
std::vector<Tick> x_ticks_of(const Panel& panel, const Rectangle& view, double width, double size) {
  if (panel.x_ticks()) return *panel.x_ticks();
  double wanted = std::min(8.0, width / (3.0 * size));
  for (; wanted > 1.0; wanted -= 0.5) {
    std::vector<Tick> ticks = nice_x_ticks(panel, view, wanted);
    const double room = width / std::max(1.0, static_cast<double>(ticks.size()));
    if (widest(ticks, size) + 0.8 * size < room) return ticks;
  }
  return nice_x_ticks(panel, view, 1.0);
}

std::vector<Tick> y_ticks_of(const Panel& panel, const Rectangle& view, double height,
                             double size) {
  if (panel.y_ticks()) return *panel.y_ticks();
  double wanted = std::clamp(height / (2.4 * size), 1.0, 7.0);
  std::vector<Tick> ticks = nice_ticks(view.y_min, view.y_max, wanted);
  while (ticks.size() < 2 && wanted < 7.0) {  // one number is no scale
    wanted += 1.0;
    ticks = nice_ticks(view.y_min, view.y_max, wanted);
  }
  return ticks;
}

// ---- Maps -------------------------------------------------------------------------------------

constexpr Eigen::Index most_cells = 400;  // of a map, a side; larger ones are averaged

/// The grid itself, or blocks of its cells averaged so that no side has more than most_cells.
Grid thinned(const Grid& grid) {
  const Eigen::Index block = (std::max(grid.z.rows(), grid.z.cols()) + most_cells - 1) / most_cells;
  if (block <= 1) return grid;
  Grid thin{grid.origin, grid.cell * static_cast<double>(block), {}};
  thin.z.resize((grid.z.rows() + block - 1) / block, (grid.z.cols() + block - 1) / block);
  for (Eigen::Index row = 0; row < thin.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < thin.z.cols(); ++col) {
      const auto cells =
          grid.z.block(row * block, col * block, std::min(block, grid.z.rows() - row * block),
                       std::min(block, grid.z.cols() - col * block));
      const auto known = cells.isFinite();
      thin.z(row, col) = known.any()
                             ? known.select(cells, 0.0).sum() / static_cast<double>(known.count())
                             : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return thin;
}

/// A run of cells of one colour along a row.
struct Run {
  Eigen::Index row, first, length;
};

std::map<std::string, std::vector<Run>> runs_by_colour(const Grid& grid, const ColourScale& scale) {
  std::map<std::string, std::vector<Run>> runs;
  const auto colour = [&](Eigen::Index row, Eigen::Index col) {
    const double value = grid.z(row, col);
    return std::isfinite(value) ? scale.colour(value) : std::string();
  };
  for (Eigen::Index row = 0; row < grid.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < grid.z.cols();) {
      const std::string of_run = colour(row, col);
      const Eigen::Index first = col;
      while (col < grid.z.cols() && colour(row, col) == of_run) ++col;
      if (!of_run.empty()) runs[of_run].push_back({row, first, col - first});
    }
  }
  return runs;
}

// ---- Layout -----------------------------------------------------------------------------------

/// Where a panel's data lie on the page.
struct Frame {
  Rectangle data;
  Box box;
  double margin = 0.0;  ///< left of it [pt]
  double x(double value) const {
    return box.left + box.width * (value - data.x_min) / (data.x_max - data.x_min);
  }
  double y(double value) const {
    return box.top + box.height * (data.y_max - value) / (data.y_max - data.y_min);
  }
  Eigen::Vector2d at(const Eigen::Vector2d& point) const { return {x(point.x()), y(point.y())}; }
};

/// The view so large that a metre is as long in both directions.
Rectangle grown_to(const Rectangle& view, double width, double height) {
  const double scale =
      std::max((view.x_max - view.x_min) / width, (view.y_max - view.y_min) / height);
  const double x = 0.5 * (view.x_min + view.x_max);
  const double y = 0.5 * (view.y_min + view.y_max);
  return {x - 0.5 * scale * width, y - 0.5 * scale * height, x + 0.5 * scale * width,
          y + 0.5 * scale * height};
}

/// A line of so many points that they cannot be told apart: of each few the lowest and the highest.
Points thinned(Points line) {
  constexpr std::size_t most = 8000;
  if (line.size() <= most) return line;
  const std::size_t block = (2 * line.size() + most - 1) / most;
  Points thin = {line.front()};
  for (auto at = line.begin(); at != line.end();) {
    const auto end = line.end() - at > static_cast<std::ptrdiff_t>(block)
                         ? at + static_cast<std::ptrdiff_t>(block)
                         : line.end();
    auto [first, second] =
        std::minmax_element(at, end, [](const auto& a, const auto& b) { return a.y() < b.y(); });
    if (second < first) std::swap(first, second);
    thin.insert(thin.end(), {*first, *second});
    at = end;
  }
  thin.push_back(line.back());
  return thin;
}

/// Words of a text in lines of at most this width.
std::vector<std::string> wrapped(const std::string& text, double width, double size) {
  std::vector<std::string> lines = {""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
    if (lines.back().empty() || text_width(longer, size) <= width) {
      lines.back() = std::move(longer);
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

/// The text, or as much of it as fits.
std::string fitted(std::string text, double width, double size, bool bold = false) {
  if (text_width(text, size, bold) <= width) return text;
  while (!text.empty() && text_width(text + "…", size, bold) > width) {
    do {
      const bool is_middle = (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U;
      text.pop_back();
      if (!is_middle) break;
    } while (!text.empty());
  }
  return text.empty() ? text : text + "…";
}

/// How much longer a metre is upwards than to the right: "heights × 2.6".
std::string exaggeration_text(const Frame& frame) {
  const double up = frame.box.height / (frame.data.y_max - frame.data.y_min);
  const double along = frame.box.width / (frame.data.x_max - frame.data.x_min);
  return "heights × " + readable(up / along, 2);
}

/// Whether a stretch of a line runs through a box.
bool crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Box& box) {
  double from = 0.0;
  double to = 1.0;
  const Eigen::Array2d low(box.left, box.top);
  const Eigen::Array2d high(box.right(), box.bottom());
  for (int axis = 0; axis < 2; ++axis) {
    const double way = b[axis] - a[axis];
    if (way == 0.0) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
      continue;
    }
    const double at_low = (low[axis] - a[axis]) / way;
    const double at_high = (high[axis] - a[axis]) / way;
    from = std::max(from, std::min(at_low, at_high));
    to = std::min(to, std::max(at_low, at_high));
  }
  return from <= to;
}

/// Lays out a figure from above to below and draws it.
class Sheet {
 public:
  Sheet(const Figure& figure, const SheetSize& size)
      : figure_(figure),
        scale_(std::max(1.0, size.width / 170.0)),
        width_(size.width * points_per_mm) {
    if (size.height) height_ = *size.height * points_per_mm;
    stack_rows();
    collect_keys();
    if (!height_) return;
    leave_out();
    fit_height();
  }

  Drawing draw() {
    drawing_.title = figure_.title;
    drawing_.width = width_;
    double y = pad();
    for (const Row& row : rows_) y = draw_row(row, y);
    if (figure_.colour_bar) y = draw_colour_bar(y);
    y = draw_legend(y);
    y = draw_lines(wrapped_note(), y, gap());
    if (!figure_.table.empty()) y = draw_table(y + gap());
    drawing_.height = height_.value_or(std::ceil(y + pad()));
    return std::move(drawing_);
  }

 private:
  struct Row {
    std::vector<const Panel*> panels;
    double height = 0.0;  ///< of the axes [pt]
  };

  // Sizes [pt].
  double number() const { return 7.0 * scale_; }
  double text() const { return 7.5 * scale_; }
  double line() const { return 10.0 * scale_; }
  double pad() const { return 3.0 * scale_; }
  double gap() const { return 5.0 * scale_; }
  double inner() const { return width_ - 2.0 * pad(); }

  /// What a given height has no room for.
  void leave_out() {
    drawing_.needed_height = least_height();
    while (!fits() && rows_.size() > 1) {
      for (const Panel* panel : rows_.back().panels) {
        const std::string& name = panel->title().empty() ? panel->y_label() : panel->title();
        drawing_.left_out.push_back("the panel '" + name + "'");
      }
      rows_.pop_back();
      collect_keys();
    }
    if (!fits() && !keys_.empty()) {
      drawing_.left_out.emplace_back("the legend");
      keys_.clear();
    }
    if (!fits()) drawing_.left_out.emplace_back("axes of a readable height");
  }

  void collect_keys() {
    keys_.clear();
    for (const Row& row : rows_) {
      for (const Panel* panel : row.panels) {
        for (const Panel::Shape& shape : panel->shapes()) {
          const auto same = [&](const Panel::Shape* key) { return key->text == shape.text; };
          if (shape.text.empty() || is_text(shape)) continue;
          if (std::none_of(keys_.begin(), keys_.end(), same)) keys_.push_back(&shape);
        }
      }
    }
  }

  void stack_rows() {
    const double least = 50.0 * points_per_mm * scale_;
    const auto most = std::max<std::size_t>(1, static_cast<std::size_t>(width_ / least));
    for (const auto& panels : figure_.rows) {
      for (std::size_t i = 0; i < panels.size(); i += most) {
        Row row;
        for (std::size_t j = i; j < std::min(i + most, panels.size()); ++j) {
          row.panels.push_back(&panels[j]);
        }
        rows_.push_back(row);
      }
    }
    for (int pass = 0; pass < 3; ++pass) {  // axes, their numbers, and the room that these take
      for (Row& row : rows_) {
        row.height = 0.0;
        for (std::size_t i = 0; i < row.panels.size(); ++i) {
          const double words = height_of_words(*row.panels[i], left(i));
          row.height =
              std::max({row.height, wanted_height(*row.panels[i], axes_width(row)), words});
        }
      }
      measure_margins();
    }
  }

  void measure_margins() {
    std::vector<double> found;
    for (const Row& row : rows_) {
      found.resize(std::max(found.size(), row.panels.size()), 0.0);
      for (std::size_t i = 0; i < row.panels.size(); ++i) {
        found[i] = std::max(found[i], margin_of(*row.panels[i], row));
      }
    }
    left_ = std::move(found);
  }

  /// Words beside axes like those of the first panel of a row are given once.
  static bool repeats_words(const Panel& panel, const Row& row) {
    const Panel& first = *row.panels.front();
    return &panel != &first && panel.y_ticks() && panel.y_ticks() == first.y_ticks();
  }

  double margin_of(const Panel& panel, const Row& row) const {
    if (repeats_words(panel, row)) return 4.0 * scale_;
    const Rectangle view = view_in(panel, axes_width(row), row.height);
    const double numbers = widest(y_ticks_of(panel, view, row.height, number()), number());
    const double name = panel.y_label().empty() ? 0.0 : line();
    const auto own = std::count_if(row.panels.begin(), row.panels.end(),
                                   [&](const Panel* each) { return !repeats_words(*each, row); });
    const double most = 0.6 * inner() / static_cast<double>(own);
    return std::min(numbers + name + 6.5 * scale_, most);
  }

  /// Words beside axes in the lines that they need.
  std::vector<std::string> lines_of(const Panel::Tick& tick, double margin) const {
    return wrapped(tick.second, margin - 4.0 * scale_, number());
  }
  double pitch() const { return 1.1 * number(); }

  /// Of axes beside which all words find room.
  double height_of_words(const Panel& panel, double margin) const {
    if (!panel.y_ticks() || margin <= 4.0 * scale_) return 0.0;
    std::size_t most = 1;
    for (const Tick& tick : *panel.y_ticks()) most = std::max(most, lines_of(tick, margin).size());
    return static_cast<double>(most * panel.y_ticks()->size()) * pitch();
  }

  /// Room left of the axes of each panel in a column.
  double left(std::size_t column) const { return column < left_.size() ? left_[column] : 0.0; }

  /// Width of the axes of each panel of a row.
  double axes_width(const Row& row) const {
    const auto count = static_cast<double>(row.panels.size());
    double width = inner() - (count - 1.0) * gap() - count * right();
    for (std::size_t i = 0; i < row.panels.size(); ++i) width -= left(i);
    return std::max(10.0, width / count);
  }
  double right() const { return 8.0 * scale_; }

  double wanted_height(const Panel& panel, double width) const {
    const double least = panel.least_height() * scale_;
    const double most = std::max(least, 80.0 * points_per_mm * scale_);
    if (!panel.has_equal_aspect()) return std::clamp(panel.shape() * width, least, most);
    const Rectangle view = panel.shown();
    const double ratio = (view.y_max - view.y_min) / (view.x_max - view.x_min);
    return std::max(least, std::clamp(ratio, 0.2, 1.1) * width);
  }

  /// What a panel shows in axes of this size.
  Rectangle view_in(const Panel& panel, double width, double height) const {
    const Rectangle view = panel.shown();
    return panel.has_equal_aspect() && !panel.has_map() ? grown_to(view, width, height) : view;
  }

  static bool is_text(const Panel::Shape& shape) {
    return shape.kind == Panel::Kind::label || shape.kind == Panel::Kind::remark;
  }

  // Heights of what is not axes.
  bool has_title(const Row& row) const {
    return std::any_of(row.panels.begin(), row.panels.end(),
                       [](const Panel* panel) { return !panel->title().empty(); });
  }
  bool hides_x(const Row& row) const {
    if (&row == &rows_.back()) return false;
    return std::all_of(row.panels.begin(), row.panels.end(),
                       [](const Panel* panel) { return panel->hides_x(); });
  }
  /// Whether the names of y stand above the axes, as one is longer than its axis.
  bool names_are_above() const {
    for (const Row& row : rows_) {
      for (const Panel* panel : row.panels) {
        if (text_width(panel->y_label(), text()) > row.height + 6.0 * scale_) return true;
      }
    }
    return false;
  }
  double head_of(const Row& row) const {
    const double lines = (has_title(row) ? 1.0 : 0.0) + (names_are_above() ? 1.0 : 0.0);
    return lines * line() + 3.0 * scale_;
  }
  double foot_of(const Row& row) const {
    if (hides_x(row)) return 3.0 * scale_;
    const bool named = std::any_of(row.panels.begin(), row.panels.end(),
                                   [](const Panel* panel) { return !panel->x_label().empty(); });
    return (named ? 2.0 : 1.0) * line() + 4.0 * scale_;
  }

  struct LegendLine {
    std::vector<const Panel::Shape*> keys;
  };
  double key_width(const Panel::Shape& key) const {
    return 18.0 * scale_ + text_width(key.text, number()) + 9.0 * scale_;
  }
  std::vector<LegendLine> legend_lines() const {
    std::vector<LegendLine> lines;
    double x = 0.0;
    for (const Panel::Shape* key : keys_) {
      const double width = key_width(*key);
      if (lines.empty() || x + width > inner()) {
        lines.emplace_back();
        x = 0.0;
      }
      lines.back().keys.push_back(key);
      x += width;
    }
    return lines;
  }
  std::vector<std::string> wrapped_note() const {
    if (figure_.note.empty()) return {};
    return wrapped(figure_.note, inner(), number());
  }
  std::vector<std::string> table_lines() const {
    std::vector<std::string> lines;
    for (const std::string& row : figure_.table) {
      for (std::string& part : wrapped(row, inner(), number())) lines.push_back(std::move(part));
    }
    return lines;
  }
  double fixed_height() const {
    double height = 2.0 * pad();
    for (const Row& row : rows_) height += head_of(row) + foot_of(row) + gap();
    if (figure_.colour_bar) height += 3.0 * line();
    height += line() * static_cast<double>(legend_lines().size() + wrapped_note().size());
    if (!wrapped_note().empty()) height += gap();
    if (!figure_.table.empty()) {
      height += gap() + line() * (1.0 + static_cast<double>(table_lines().size()));
    }
    return height;
  }

  double least_height() const {
    return fixed_height() + 32.0 * scale_ * static_cast<double>(rows_.size());
  }
  bool fits() const { return *height_ >= least_height(); }

  /// Shares what is left of a given height among the rows.
  void fit_height() {
    for (int pass = 0; pass < 3; ++pass) {  // names above low axes take room, too
      double sum = 0.0;
      for (const Row& row : rows_) sum += row.height;
      const double left =
          std::max(4.0 * static_cast<double>(rows_.size()), *height_ - fixed_height());
      for (Row& row : rows_) row.height *= left / sum;
      measure_margins();
    }
  }

  // ---- Drawing ----

  void add(DrawnItem item) { drawing_.items.push_back(std::move(item)); }
  void put(DrawnText text) {
    if (!text.text.empty()) add(std::move(text));
  }
  Style thin(const std::string& colour) const { return {colour, 0.5 * scale_}; }
  Style scaled(Style style) const {
    style.width *= scale_;
    for (double& length : style.dash) length *= scale_;
    return style;
  }

  double draw_row(const Row& row, double top) {
    double x = pad();
    const double y = top + head_of(row);
    const double width = axes_width(row);
    for (std::size_t i = 0; i < row.panels.size(); ++i) {
      const Panel& panel = *row.panels[i];
      x += left(i);
      Frame frame{view_in(panel, width, row.height), {x, y, width, row.height}, left(i)};
      if (panel.has_map() && panel.has_equal_aspect()) shrink(frame);
      draw_panel(panel, frame, row, top);
      x += width + right() + gap();
    }
    return y + row.height + foot_of(row) + gap();
  }

  /// Axes as high and wide as the view asks for.
  static void shrink(Frame& frame) {
    const double per_metre = std::min(frame.box.width / (frame.data.x_max - frame.data.x_min),
                                      frame.box.height / (frame.data.y_max - frame.data.y_min));
    const double width = per_metre * (frame.data.x_max - frame.data.x_min);
    const double height = per_metre * (frame.data.y_max - frame.data.y_min);
    frame.box.top += frame.box.height - height;
    frame.box.width = width;
    frame.box.height = height;
  }

  void draw_panel(const Panel& panel, const Frame& frame, const Row& row, double top) {
    const Box& box = frame.box;
    const auto xs = x_ticks_of(panel, frame.data, box.width, number());
    const auto ys = y_ticks_of(panel, frame.data, box.height, number());
    if (!panel.has_map() && !panel.has_equal_aspect()) draw_grid(frame, ys);
    add(Clip{box});
    for (const Panel::Shape& shape : panel.shapes()) draw_shape(shape, frame);
    add(Clip{});
    draw_box(box, thin("#444444"));
    for (const Panel::Shape& shape : panel.shapes()) draw_dots(shape, frame);
    draw_labels(panel, frame, Panel::Kind::label);
    draw_remarks(panel, frame);
    if (!hides_x(row)) draw_x(panel, frame, xs);
    if (!repeats_words(panel, row)) draw_y(panel, frame, ys, names_are_above());
    const double cell_right = box.left + axes_width(row) + right();
    std::string title = panel.title();
    if (panel.states_exaggeration()) title += ", " + exaggeration_text(frame);
    if (!title.empty()) {
      const double baseline = box.top - 3.5 * scale_ - (names_are_above() ? line() : 0.0);
      put({{box.left, std::max(baseline, top + 0.8 * text())},
           fitted(title, cell_right - box.left, text(), true),
           text(),
           Anchor::start,
           false,
           true});
    }
  }

  void draw_grid(const Frame& frame, const std::vector<Tick>& ys) {
    for (const Tick& tick : ys) {
      if (tick.second.empty() || tick.first <= frame.data.y_min || tick.first >= frame.data.y_max) {
        continue;
      }
      const double y = frame.y(tick.first);
      add(DrawnPath{{{{frame.box.left, y}, {frame.box.right(), y}}}, false, thin("#e4e4e4")});
    }
  }

  void draw_box(const Box& box, const Style& style) {
    add(DrawnPath{{{{box.left, box.top},
                    {box.right(), box.top},
                    {box.right(), box.bottom()},
                    {box.left, box.bottom()}}},
                  true,
                  style});
  }

  void draw_x(const Panel& panel, const Frame& frame, const std::vector<Tick>& ticks) {
    const Box& box = frame.box;
    const bool words = panel.x_ticks().has_value();
    const double room = words && !ticks.empty()
                            ? (box.width + right()) / static_cast<double>(ticks.size())
                            : box.width;
    const double gap_of_words = words ? 0.5 * number() : 0.0;
    const auto every = static_cast<std::size_t>(
        panel.skips_x_ticks() ? std::ceil((widest(ticks, number()) + gap_of_words) / room) : 1.0);
    for (std::size_t i = 0; i < ticks.size(); i += std::max<std::size_t>(1, every)) {
      const Tick& tick = ticks[i];
      const double x = frame.x(tick.first);
      if (x < box.left - 0.1 || x > box.right() + 0.1) continue;
      if (!words) {
        add(DrawnPath{
            {{{x, box.bottom()}, {x, box.bottom() + 2.5 * scale_}}}, false, thin("#444444")});
      }
      const double most = room * static_cast<double>(every) - gap_of_words;
      put({{x, box.bottom() + line()},
           fitted(tick.second, most, number()),
           number(),
           Anchor::middle});
    }
    const double cell = box.width + frame.margin + right();
    const std::string name = fitted(panel.x_label(), cell, text());
    const double half = 0.5 * text_width(name, text());
    const double middle = std::clamp(box.left + 0.5 * box.width, pad() + half,
                                     std::max(pad() + half, width_ - pad() - half));
    put({{middle, box.bottom() + 2.0 * line()}, name, text(), Anchor::middle});
  }

  void draw_y(const Panel& panel, const Frame& frame, const std::vector<Tick>& ticks, bool above) {
    const Box& box = frame.box;
    for (const Tick& tick : ticks) {
      const double y = frame.y(tick.first);
      if (y < box.top - 0.1 || y > box.bottom() + 0.1) continue;
      if (!panel.y_ticks()) {
        add(DrawnPath{{{{box.left - 2.5 * scale_, y}, {box.left, y}}}, false, thin("#444444")});
      }
      const std::vector<std::string> lines = lines_of(tick, frame.margin);
      double baseline =
          std::clamp(y + 0.36 * number(), box.top + 0.5 * number(), box.bottom() + 0.4 * number()) -
          0.5 * pitch() * static_cast<double>(lines.size() - 1);
      for (const std::string& each : lines) {
        put({{box.left - 4.0 * scale_, baseline},
             fitted(each, frame.margin - 4.0 * scale_, number()),
             number(),
             Anchor::end});
        baseline += pitch();
      }
    }
    if (above) {
      const double room = box.width + right() + 0.5 * frame.margin;
      put({{box.left - 0.5 * frame.margin, box.top - 3.5 * scale_},
           fitted(panel.y_label(), room, text()),
           text(),
           Anchor::start});
      return;
    }
    const double half = 0.5 * text_width(panel.y_label(), text());
    const double middle = std::max(box.top + 0.5 * box.height, half + pad());
    put({{box.left - frame.margin + 0.75 * line(), middle},
         panel.y_label(),
         text(),
         Anchor::middle,
         true});
  }

  void draw_shape(const Panel::Shape& shape, const Frame& frame) {
    Style style = scaled(shape.style);
    switch (shape.kind) {
      case Panel::Kind::map:
        return draw_map(shape, frame);
      case Panel::Kind::label:
      case Panel::Kind::remark:
      case Panel::Kind::dots:
        return;
      case Panel::Kind::span:
        return draw_span(shape, frame);
      case Panel::Kind::interval:
        return draw_interval(frame.at(shape.points[0]), frame.at(shape.points[1]), style);
      default:
        break;
    }
    add(DrawnPath{parts_of(shape, frame), shape.kind == Panel::Kind::polygon, style});
  }

  /// Those within the axes, whole also at a border.
  void draw_dots(const Panel::Shape& shape, const Frame& frame) {
    if (shape.kind != Panel::Kind::dots) return;
    for (const Eigen::Vector2d& point : shape.points) {
      const Eigen::Vector2d at = frame.at(point);
      if (!at.allFinite() || !frame.box.contains(at, 0.5)) continue;
      add(DrawnCircle{at, scale_ * shape.radius, scaled(shape.style)});
    }
  }

  /// Unknown points interrupt a line.
  static std::vector<Points> parts_of(const Panel::Shape& shape, const Frame& frame) {
    std::vector<Points> parts;
    bool interrupted = true;
    for (std::size_t i = 0; i < shape.points.size(); ++i) {
      if (!shape.points[i].allFinite()) {
        interrupted = true;
        continue;
      }
      if (interrupted || (shape.kind == Panel::Kind::strokes && i % 2 == 0)) parts.emplace_back();
      interrupted = false;
      parts.back().push_back(frame.at(shape.points[i]));
    }
    for (Points& part : parts) part = thinned(std::move(part));
    return parts;
  }

  void draw_interval(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Style& style) {
    if (!a.allFinite() || !b.allFinite()) return;
    const Eigen::Vector2d along =
        (b - a).norm() > 0.0 ? (b - a).normalized().eval() : Eigen::Vector2d(0.0, 1.0);
    const Eigen::Vector2d cap = 2.2 * scale_ * Eigen::Vector2d(-along.y(), along.x());
    add(DrawnPath{{{a, b}, {a - cap, a + cap}, {b - cap, b + cap}}, false, style});
  }

  void draw_span(const Panel::Shape& shape, const Frame& frame) {
    const double left = frame.x(shape.points[0].x());
    const double right_end = frame.x(shape.points[1].x());
    const Box& box = frame.box;
    const double strip = 3.5 * scale_;
    draw_box({left, box.top, right_end - left, strip}, shape.style);
    add(DrawnPath{{{{right_end, box.top}, {right_end, box.bottom()}}}, false, thin("#c0c0c0")});
  }

  void draw_map(const Panel::Shape& shape, const Frame& frame) {
    if (shape.style.fill != "none") {
      add(DrawnCells{shape.style.fill,
                     {cells(shape.grid, {0, 0, shape.grid.z.cols()}, frame, shape.grid.z.rows())}});
    }
    const Grid grid = thinned(shape.grid);
    for (const auto& [colour, runs] : runs_by_colour(grid, shape.scale)) {
      DrawnCells drawn{colour, {}};
      for (const Run& run : runs) drawn.boxes.push_back(cells(grid, run, frame, 1));
      add(std::move(drawn));
    }
  }

  static Box cells(const Grid& grid, const Run& run, const Frame& frame, Eigen::Index rows) {
    const auto corner = [&](Eigen::Index row, Eigen::Index col) {
      return frame.at({grid.origin.x() + grid.cell.x() * static_cast<double>(col),
                       grid.origin.y() + grid.cell.y() * static_cast<double>(row)});
    };
    const Eigen::Vector2d low = corner(run.row, run.first);
    const Eigen::Vector2d high = corner(run.row + rows, run.first + run.length);
    return {low.x(), high.y(), high.x() - low.x(), low.y() - high.y()};
  }

  /// Labels beside lines and one another, each tied to its point where it could not stay there.
  void draw_labels(const Panel& panel, const Frame& frame, Panel::Kind kind) {
    Obstacles obstacles = obstacles_of(panel, frame);
    std::vector<DrawnText> texts;
    for (const Panel::Shape& shape : panel.shapes()) {
      if (shape.kind != kind) continue;
      const double width = text_width(shape.text, number()) + 4.0 * scale_;
      if (width > frame.box.width || frame.box.height < line()) continue;
      const Eigen::Vector2d at = frame.at(shape.points[0]);
      const std::optional<Box> box = free_box(at, width, frame.box, obstacles);
      if (!box) continue;
      if (!box->contains(at, 0.0)) draw_tie(at, *box, obstacles);
      obstacles.texts.push_back(*box);
      texts.push_back({{box->left + 0.5 * width, box->top + 0.5 * line() + 0.36 * number()},
                       shape.text,
                       number(),
                       Anchor::middle});
    }
    for (DrawnText& text : texts) {
      text.halo = true;
      add(std::move(text));
    }
  }

  /// What a label should not cover, on the page.
  struct Obstacles {
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> lines;
    std::vector<Box> texts;
  };

  Obstacles obstacles_of(const Panel& panel, const Frame& frame) const {
    Obstacles obstacles;
    const auto add_line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      if (a.allFinite() && b.allFinite()) obstacles.lines.emplace_back(frame.at(a), frame.at(b));
    };
    for (const Panel::Shape& shape : panel.shapes()) {
      const Points& points = shape.points;
      const bool is_polygon = shape.kind == Panel::Kind::polygon;
      const bool is_line = shape.kind == Panel::Kind::line || is_polygon;
      if (shape.kind == Panel::Kind::dots) {
        for (const Eigen::Vector2d& dot : points) add_line(dot, dot);
      }
      if (!is_line || shape.style.stroke == "none" || points.empty()) continue;
      for (std::size_t i = 1; i < points.size(); ++i) add_line(points[i - 1], points[i]);
      if (is_polygon) add_line(points.back(), points.front());
    }
    return obstacles;
  }

  /// The box of a label that is nearest to a point and covers nothing; else only no other label.
  std::optional<Box> free_box(const Eigen::Vector2d& at, double width, const Box& frame,
                              const Obstacles& obstacles) const {
    constexpr int directions = 16;
    const double step = 0.4 * line();
    std::optional<Box> fallback;
    for (double distance = 0.0; distance < frame.width + frame.height; distance += step) {
      for (int i = 0; i < (distance > 0.0 ? directions : 1); ++i) {
        const double angle = 0.5 * pi + 2.0 * pi * (i % 2 == 0 ? i : -i - 1) / (2 * directions);
        const Box box{at.x() + distance * std::cos(angle) - 0.5 * width,
                      at.y() - distance * std::sin(angle) - 0.5 * line(), width, line()};
        if (!is_free_of_texts(box, frame, obstacles)) continue;
        if (!fallback) fallback = box;
        if (!is_crossed(box, obstacles)) return box;
      }
    }
    return fallback;
  }

  static bool is_free_of_texts(const Box& box, const Box& frame, const Obstacles& obstacles) {
    if (box.top < frame.top || box.bottom() > frame.bottom() + 0.1) return false;
    if (box.left < frame.left || box.right() > frame.right()) return false;
    return std::none_of(obstacles.texts.begin(), obstacles.texts.end(), [&](const Box& other) {
      return box.left < other.right() && other.left < box.right() && box.top < other.bottom() &&
             other.top < box.bottom();
    });
  }

  static bool is_crossed(const Box& box, const Obstacles& obstacles) {
    return std::any_of(obstacles.lines.begin(), obstacles.lines.end(),
                       [&](const auto& line) { return crosses(line.first, line.second, box); });
  }

  /// A thin line from a dot at the point to the nearest place of the box.
  void draw_tie(const Eigen::Vector2d& at, const Box& box, Obstacles& obstacles) {
    const Eigen::Vector2d end(std::clamp(at.x(), box.left, box.right()),
                              std::clamp(at.y(), box.top, box.bottom()));
    add(DrawnPath{{{at, end}}, false, {"#ffffff", 1.6 * scale_}});
    add(DrawnPath{{{at, end}}, false, thin("#222222")});
    add(DrawnCircle{at, 1.3 * scale_, {"#ffffff", 0.5 * scale_, "#222222"}});
    obstacles.lines.emplace_back(at, end);
  }

  /// Side by side where each has room, else upright, and as many of these as have room; where the
  /// axes are too low for that, as labels.
  void draw_remarks(const Panel& panel, const Frame& frame) {
    std::vector<const Panel::Shape*> remarks;
    double room = frame.box.width;
    double longest = 0.0;
    for (const Panel::Shape& shape : panel.shapes()) {
      if (shape.kind != Panel::Kind::remark) continue;
      remarks.push_back(&shape);
      room = std::min(room, frame.x(shape.points[1].x()) - frame.x(shape.points[0].x()));
      longest = std::max(longest, text_width(shape.text, number()));
    }
    const bool upright = longest + 2.0 * scale_ > room;
    if (upright && longest > 0.8 * frame.box.height) {
      return draw_labels(panel, frame, Panel::Kind::remark);
    }
    const double extent = upright ? longest : number();
    const auto every = upright ? static_cast<std::size_t>(std::ceil(line() / room)) : 1;
    for (std::size_t i = 0; i < remarks.size(); i += every) {
      const Eigen::Vector2d above = frame.at(remarks[i]->points[0]) - Eigen::Vector2d(0.0, 3.0);
      const double half = 0.5 * (upright ? number() : longest);
      const double x = std::clamp(above.x(), frame.box.left + half, frame.box.right() - half);
      DrawnText drawn{{x + (upright ? 0.36 * number() : 0.0),
                       std::max(above.y(), frame.box.top + extent + 2.0 * scale_)},
                      remarks[i]->text,
                      number(),
                      upright ? Anchor::start : Anchor::middle,
                      upright};
      drawn.halo = true;
      add(std::move(drawn));
    }
  }

  // ---- Below the panels ----

  double draw_legend(double y) {
    for (const LegendLine& keys : legend_lines()) {
      double width = -9.0 * scale_;
      for (const Panel::Shape* key : keys.keys) width += key_width(*key);
      double x = std::max(pad(), 0.5 * (width_ - width));
      for (const Panel::Shape* key : keys.keys) {
        draw_key(*key, x, y + 0.5 * line());
        put({{x + 18.0 * scale_, y + 0.5 * line() + 0.36 * number()},
             fitted(key->text, width_ - pad() - x - 18.0 * scale_, number()),
             number(),
             Anchor::start});
        x += key_width(*key);
      }
      y += line();
    }
    return y;
  }

  void draw_key(const Panel::Shape& key, double x, double y) {
    const double length = 14.0 * scale_;
    const double half = 3.0 * scale_;
    Style style = scaled(key.style);
    if (key.kind == Panel::Kind::dots) {
      add(DrawnCircle{{x + 0.5 * length, y}, scale_ * std::clamp(key.radius, 1.2, 3.0), style});
    } else if (key.kind == Panel::Kind::interval) {
      draw_interval({x, y}, {x + length, y}, style);
    } else if (key.style.fill != "none") {
      style.width = std::min(style.width, scale_);
      add(DrawnPath{
          {{{x, y - half}, {x + length, y - half}, {x + length, y + half}, {x, y + half}}},
          true,
          style});
    } else {
      style.width = std::min(style.width, 2.5 * scale_);
      add(DrawnPath{{{{x, y}, {x + length, y}}}, false, style});
    }
  }

  /// Colours from left to right, their numbers and what they are of.
  double draw_colour_bar(double y) {
    const ColourBar& bar = *figure_.colour_bar;
    const double width = std::min(0.85 * inner(), 90.0 * points_per_mm * scale_);
    const Box box{0.5 * (width_ - width), y, width, 6.0 * scale_};
    if (bar.scale.bands.empty()) {
      draw_even_colours(bar, box);
    } else {
      draw_bands(bar, box);
    }
    draw_box(box, thin("#444444"));
    put({{0.5 * width_, box.bottom() + 2.0 * line()},
         fitted(bar.label, inner(), text()),
         text(),
         Anchor::middle});
    return y + 3.0 * line();
  }

  void draw_even_colours(const ColourBar& bar, const Box& box) {
    constexpr int steps = 40;
    for (int i = 0; i < steps; ++i) {
      const double value = bar.scale.low + (bar.scale.high - bar.scale.low) * (i + 0.5) / steps;
      add(DrawnCells{bar.scale.colour(value),
                     {{box.left + box.width * i / steps, box.top, box.width / steps, box.height}}});
    }
    const double low = bar.scale.low / bar.unit;
    const double high = bar.scale.high / bar.unit;
    for (const Tick& tick : nice_ticks(low, high, 6.0)) {
      const double x = box.left + box.width * (tick.first - low) / (high - low);
      put({{x, box.bottom() + line() - 1.0 * scale_}, tick.second, number(), Anchor::middle});
    }
  }

  void draw_bands(const ColourBar& bar, const Box& box) {
    const auto count = static_cast<int>(bar.scale.bands.size());
    const double step = box.width / (2 * count + 1);
    double widest_number = 0.0;
    const auto number_of = [&](int band) {
      const double bound = bar.scale.bands[static_cast<std::size_t>(std::abs(band) - 1)];
      return (band > 0 ? "+" : "−") + short_number(bound / bar.unit, 2);
    };
    for (int band = 1; band <= count; ++band) {
      widest_number = std::max(widest_number, text_width(number_of(band), number()));
    }
    const int every = static_cast<int>(std::ceil((widest_number + 2.0 * scale_) / step));
    for (int band = -count; band <= count; ++band) {
      const double left = box.left + step * (band + count);
      add(DrawnCells{colour_of_band(band, bar.scale.bands.size()),
                     {{left, box.top, step, box.height}}});
      if (band == 0 || std::abs(band) % every != 0) continue;
      const double x = band > 0 ? left : left + step;
      put({{x, box.bottom() + line() - 1.0 * scale_}, number_of(band), number(), Anchor::middle});
    }
  }

  double draw_lines(const std::vector<std::string>& lines, double y, double before) {
    if (!lines.empty()) y += before;
    for (const std::string& each : lines) {
      y += line();
      put({{pad(), y - 0.3 * line()}, each, number(), Anchor::start});
    }
    return y;
  }

  double draw_table(double y) {
    y += line();
    put({{pad(), y - 0.3 * line()},
         fitted(figure_.title, inner(), text(), true),
         text(),
         Anchor::start,
         false,
         true});
    return draw_lines(table_lines(), y, 0.0);
  }

  const Figure& figure_;
  double scale_;
  double width_;
  std::optional<double> height_ = {};
  std::vector<Row> rows_;
  std::vector<const Panel::Shape*> keys_;
  std::vector<double> left_;  ///< room left of the axes in each column, for numbers and name of y
  Drawing drawing_;
};

}  // namespace

Drawing lay_out(const Figure& figure, const SheetSize& size) { return Sheet(figure, size).draw(); }

}  // namespace excavplan
