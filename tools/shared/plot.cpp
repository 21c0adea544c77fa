// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace excavplan::tools {
namespace {

constexpr double font = 13.0;         // [px]
constexpr double line_height = 18.0;  // [px]
constexpr double character = 0.58;    // mean width of a character over the font size
const char* const unknown_colour = "#c8c8c8";
constexpr Eigen::Index most_cells = 400;  // of a heat map, a side; larger maps are averaged

std::string fixed(double value, int decimals) {
  std::array<char, 400> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {text.data(), end};
}

/// A coordinate in pixels: two decimals, without trailing zeros.
std::string px(double value) {
  std::string text = fixed(value, 2);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// Characters, not bytes, of UTF-8 text.
double text_width(const std::string& text) {
  const auto count = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  });
  return character * font * static_cast<double>(count);
}

std::string attributes(const Style& style) {
  std::string text = " fill=\"" + style.fill + "\" stroke=\"" + style.stroke + '"';
  if (style.stroke != "none") text += " stroke-width=\"" + px(style.width) + '"';
  if (style.opacity < 1.0) text += " opacity=\"" + px(style.opacity) + '"';
  if (!style.dash.empty()) text += " stroke-dasharray=\"" + style.dash + '"';
  return text;
}

struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};

/// Multiples of 1, 2 or 5 times a power of ten, about `wanted` of them.
Ticks nice_ticks(double low, double high, double wanted) {
  const double rough = (high - low) / std::max(1.0, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) {
      step = factor * power;
      break;
    }
  }
  Ticks ticks;
  ticks.decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const double first = std::ceil(low / step - 1e-9);
  for (double i = first; i * step <= high + 1e-9 * step; ++i) {
    ticks.values.push_back(i == 0.0 ? 0.0 : i * step);
  }
  return ticks;
}

/// The map itself, or blocks of its cells averaged so that no side has more than most_cells.
HeightMap thinned(const HeightMap& map) {
  const Eigen::Index block = (std::max(map.z.rows(), map.z.cols()) + most_cells - 1) / most_cells;
  if (block <= 1) return map;
  HeightMap thin{map.origin, map.cell_size * static_cast<double>(block), {}};
  thin.z.resize((map.z.rows() + block - 1) / block, (map.z.cols() + block - 1) / block);
  for (Eigen::Index row = 0; row < thin.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < thin.z.cols(); ++col) {
      const auto cells =
          map.z.block(row * block, col * block, std::min(block, map.z.rows() - row * block),
                      std::min(block, map.z.cols() - col * block));
      const auto known = cells.isFinite();
      thin.z(row, col) = known.any()
                             ? known.select(cells, 0.0).sum() / static_cast<double>(known.count())
                             : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return thin;
}

/// The band of a value, counted from 0 in the middle, with its sign.
int band_of(double value, const std::vector<double>& bands) {
  const auto beyond = std::upper_bound(bands.begin(), bands.end(), std::abs(value)) - bands.begin();
  return static_cast<int>(value < 0.0 ? -beyond : beyond);
}

std::string colour_of_band(int band, std::size_t count) {
  return diverging_colour(static_cast<double>(band) / static_cast<double>(count));
}

/// One path per band, in units of cells: runs of equal colour along a row.
std::map<int, std::string> colour_runs(const HeightMap& map, const std::vector<double>& bands) {
  std::map<int, std::string> paths;
  constexpr int unknown = std::numeric_limits<int>::min();
  const auto level = [&](Eigen::Index row, Eigen::Index col) {
    const double value = map.z(row, col);
    return std::isfinite(value) ? band_of(value, bands) : unknown;
  };
  for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < map.z.cols();) {
      const int of_run = level(row, col);
      const Eigen::Index start = col;
      while (col < map.z.cols() && level(row, col) == of_run) ++col;
      if (of_run == unknown) continue;
      const Eigen::Index length = col - start;
      paths[of_run] += "M" + std::to_string(start) + ' ' + std::to_string(row) + "h" +
                       std::to_string(length) + "v1h-" + std::to_string(length) + "z";
    }
  }
  return paths;
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

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

void Panel::marker(const Eigen::Vector2d& at, const std::string& colour,
                   const std::string& legend) {
  shapes_.push_back({Kind::marker, {at}, {"#ffffff", 1.5, colour}, legend});
}

void Panel::label(const Eigen::Vector2d& at, const std::string& text) {
  shapes_.push_back({Kind::label, {at}, {}, text});
}

void Panel::heat_map(const HeightMap& map, const std::vector<double>& bands) {
  const Rectangle all = map.extent();
  shapes_.push_back({Kind::heat_map,
                     {{all.x_min, all.y_min}, {all.x_max, all.y_max}},
                     {"#888888", 1.0, unknown_colour},
                     map.z.isFinite().all() ? "" : "not seen",
                     thinned(map),
                     bands});
}

/// The view, or the bounds of all shapes with a small margin; never empty, never thinner than 1
/// : 8.
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
    const bool map_only = std::any_of(shapes_.begin(), shapes_.end(), [](const Shape& shape) {
      return shape.kind == Kind::heat_map;
    });
    const Eigen::Array2d margin = (map_only ? 0.0 : 0.04) * (high - low);
    all = {low.x() - margin.x(), low.y() - margin.y(), high.x() + margin.x(),
           high.y() + margin.y()};
  }
  const double width = all.x_max - all.x_min;
  const double height = all.y_max - all.y_min;
  const double least_width = equal_aspect_ ? std::max(height / 8.0, 1e-6) : 1e-6;
  const double least_height = equal_aspect_ ? std::max(width / 8.0, 1e-6) : 1e-6;
  const double grow_x = std::max(0.0, least_width - width) / 2.0;
  const double grow_y = std::max(0.0, least_height - height) / 2.0;
  return {all.x_min - grow_x, all.y_min - grow_y, all.x_max + grow_x, all.y_max + grow_y};
}

// ---- Writing ----------------------------------------------------------------------------------

/// Lays out a figure and writes it, from left to right.
class SvgWriter {
 public:
  explicit SvgWriter(const Figure& figure) : figure_(figure) {}

  std::string write() {
    const double top = figure_.title.empty() ? 14.0 : 46.0;
    Eigen::Vector2d end = row_at(figure_.panels, {14.0, top}, 440.0);
    if (figure_.colour_bar) end.x() = colour_bar({end.x() + 12.0, top + 26.0}, end.y() - 48.0);
    for (const Panel& panel : figure_.lower) {
      for (const Panel::Shape& shape : panel.shapes_) add_to_legend(shape);
    }
    Eigen::Vector2d corner = column({end.x() + 18.0, top + 34.0}).cwiseMax(end);
    if (!figure_.lower.empty()) {
      corner = corner.cwiseMax(row_at(figure_.lower, {14.0, corner.y() + 14.0}, 190.0));
    }
    const double title_width = 1.25 * text_width(figure_.title) + 28.0;
    const double width = std::ceil(std::max(corner.x(), title_width) + 14.0);
    const double height = std::ceil(corner.y() + 12.0);
    std::string head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + px(width) +
                       "\" height=\"" + px(height) + "\" viewBox=\"0 0 " + px(width) + ' ' +
                       px(height) +
                       "\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\"" +
                       " font-size=\"" + px(font) + "\" fill=\"#222222\">\n";
    if (!figure_.title.empty()) {
      head += "<title>" + xml_escaped(figure_.title) + "</title>\n";
    }
    head += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    if (!figure_.title.empty()) {
      head += "<text x=\"16\" y=\"30\" font-size=\"" + px(1.25 * font) +
              "\" font-weight=\"bold\">" + xml_escaped(figure_.title) + "</text>\n";
    }
    return head + svg_ + "</svg>\n";
  }

 private:
  /// Where a panel's data lie on the page.
  struct Frame {
    Rectangle data;
    double left = 0.0, top = 0.0, width = 0.0, height = 0.0;  // [px]
    double x(double value) const {
      return left + width * (value - data.x_min) / (data.x_max - data.x_min);
    }
    double y(double value) const {
      return top + height * (data.y_max - value) / (data.y_max - data.y_min);
    }
    std::string point(const Eigen::Vector2d& at) const {
      return px(x(at.x())) + ' ' + px(y(at.y()));
    }
  };

  void text(double x, double y, const std::string& content, const std::string& more = "") {
    svg_ += "<text x=\"" + px(x) + "\" y=\"" + px(y) + '"' + more + '>' + xml_escaped(content) +
            "</text>\n";
  }

  /// Panels side by side, each of at most this height [px]. @return the lower right corner
  Eigen::Vector2d row_at(const std::vector<Panel>& panels, const Eigen::Vector2d& corner,
                         double height) {
    const auto count = static_cast<double>(panels.size());
    const Eigen::Vector2d most(count > 1.0 ? 900.0 / count : 720.0, height);
    Eigen::Vector2d end = corner;
    for (const Panel& panel : panels) {
      const Eigen::Vector2d drawn = panel_at(panel, {end.x(), corner.y()}, most);
      end = {drawn.x(), std::max(end.y(), drawn.y())};
    }
    return end;
  }

  static Frame frame_of(const Panel& panel, const Eigen::Vector2d& corner,
                        const Eigen::Vector2d& most) {
    Frame frame;
    frame.data = panel.shown();
    frame.left = corner.x() + 62.0;
    frame.top = corner.y() + 26.0;
    frame.width = most.x();
    frame.height = most.y();
    if (panel.equal_aspect_) {
      const double data_width = frame.data.x_max - frame.data.x_min;
      const double data_height = frame.data.y_max - frame.data.y_min;
      const double scale = std::min(frame.width / data_width, frame.height / data_height);
      frame.width = scale * data_width;
      frame.height = scale * data_height;
    }
    return frame;
  }

  /// @return the lower right corner of what was drawn
  Eigen::Vector2d panel_at(const Panel& panel, const Eigen::Vector2d& corner,
                           const Eigen::Vector2d& most) {
    const Frame frame = frame_of(panel, corner, most);
    const std::string box = "<rect x=\"" + px(frame.left) + "\" y=\"" + px(frame.top) +
                            "\" width=\"" + px(frame.width) + "\" height=\"" + px(frame.height) +
                            '"';
    const std::string clip = "clip" + std::to_string(++clips_);
    svg_ += "<clipPath id=\"" + clip + "\">" + box + "/></clipPath>\n";
    svg_ += "<g clip-path=\"url(#" + clip + ")\">\n";
    const bool map = std::any_of(panel.shapes_.begin(), panel.shapes_.end(),
                                 [](const auto& s) { return s.kind == Panel::Kind::heat_map; });
    svg_ += box + " fill=\"" + (map ? unknown_colour : "#fbfbfb") + "\"/>\n";
    for (const Panel::Shape& shape : panel.shapes_) draw(shape, frame);
    svg_ += "</g>\n" + box + " fill=\"none\" stroke=\"#444444\"/>\n";
    labels(panel, frame);
    axes(panel, frame);
    return {frame.left + frame.width + 16.0, frame.top + frame.height + 46.0};
  }

  void axes(const Panel& panel, const Frame& frame) {
    const double bottom = frame.top + frame.height;
    const std::string middle = " text-anchor=\"middle\"";
    std::string marks;
    const Ticks x_ticks = nice_ticks(frame.data.x_min, frame.data.x_max, frame.width / 60.0);
    for (const double value : x_ticks.values) {
      marks += "M" + px(frame.x(value)) + ' ' + px(bottom) + "v5";
      text(frame.x(value), bottom + 19.0, fixed(value, x_ticks.decimals), middle);
    }
    const Ticks y_ticks = nice_ticks(frame.data.y_min, frame.data.y_max, frame.height / 45.0);
    for (const double value : y_ticks.values) {
      marks += "M" + px(frame.left) + ' ' + px(frame.y(value)) + "h-5";
      text(frame.left - 9.0, frame.y(value) + 4.5, fixed(value, y_ticks.decimals),
           " text-anchor=\"end\"");
    }
    svg_ += "<path d=\"" + marks + "\" stroke=\"#444444\"/>\n";
    text(frame.left + frame.width / 2.0, bottom + 39.0, panel.x_label_, middle);
    const double x = frame.left - 46.0;
    const double y = frame.top + frame.height / 2.0;
    text(x, y, panel.y_label_, middle + " transform=\"rotate(-90 " + px(x) + ' ' + px(y) + ")\"");
    text(frame.left, frame.top - 9.0, panel.title_, " font-weight=\"bold\"");
  }

  void draw(const Panel::Shape& shape, const Frame& frame) {
    using Kind = Panel::Kind;
    switch (shape.kind) {
      case Kind::line:
      case Kind::polygon:
      case Kind::strokes:
        path(shape, frame);
        break;
      case Kind::marker:
        svg_ += "<circle cx=\"" + px(frame.x(shape.points[0].x())) + "\" cy=\"" +
                px(frame.y(shape.points[0].y())) + "\" r=\"5.5\"" + attributes(shape.style) +
                "/>\n";
        break;
      case Kind::heat_map:
        heat_map(shape, frame);
        break;
      case Kind::label:
        return;  // labels come after all shapes
    }
    add_to_legend(shape);
  }

  void path(const Panel::Shape& shape, const Frame& frame) {
    std::string d;
    bool pen_down = false;
    for (std::size_t i = 0; i < shape.points.size(); ++i) {
      if (!shape.points[i].allFinite()) {
        pen_down = false;
        continue;
      }
      const bool starts = !pen_down || (shape.kind == Panel::Kind::strokes && i % 2 == 0);
      d += (starts ? "M" : "L") + frame.point(shape.points[i]);
      pen_down = true;
    }
    if (d.empty()) return;
    if (shape.kind == Panel::Kind::polygon) d += "Z";
    svg_ += "<path d=\"" + d + "\" stroke-linejoin=\"round\"" + attributes(shape.style) + "/>\n";
  }

  void heat_map(const Panel::Shape& shape, const Frame& frame) {
    const HeightMap& map = shape.map;
    const double scale_x = map.cell_size * frame.width / (frame.data.x_max - frame.data.x_min);
    const double scale_y = map.cell_size * frame.height / (frame.data.y_max - frame.data.y_min);
    svg_ += "<g shape-rendering=\"crispEdges\" transform=\"translate(" + frame.point(map.origin) +
            ") scale(" + fixed(scale_x, 6) + ' ' + fixed(-scale_y, 6) + ")\">\n";
    for (const auto& [band, runs] : colour_runs(map, shape.bands)) {
      svg_ +=
          "<path fill=\"" + colour_of_band(band, shape.bands.size()) + "\" d=\"" + runs + "\"/>\n";
    }
    svg_ += "</g>\n";
  }

  void labels(const Panel& panel, const Frame& frame) {
    std::vector<Rectangle> taken;
    for (const Panel::Shape& shape : panel.shapes_) {
      if (shape.kind != Panel::Kind::label) continue;
      const double half = text_width(shape.text) / 2.0 + 3.0;
      const double low = frame.left + half;
      const double high = std::max(low, frame.left + frame.width - half);
      const double x = std::clamp(frame.x(shape.points[0].x()), low, high);
      const double wanted = frame.y(shape.points[0].y()) + 4.5;
      double y = wanted;
      const auto free = [&] {
        const bool inside = y > frame.top + font && y < frame.top + frame.height - 4.0;
        return inside && std::none_of(taken.begin(), taken.end(), [&](const Rectangle& box) {
                 return x - half < box.x_max && x + half > box.x_min &&
                        std::abs(y - box.y_min) < line_height;
               });
      };
      for (int step = 1; !free() && step < 40; ++step) {
        y = wanted + (step % 2 == 0 ? -1.0 : 1.0) * (step + 1) / 2 * 0.5 * line_height;
      }
      taken.push_back({x - half, y, x + half, y});
      text(x, y, shape.text,
           " text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"3.5\" "
           "stroke-linejoin=\"round\" paint-order=\"stroke\"");
    }
  }

  void add_to_legend(const Panel::Shape& shape) {
    if (shape.text.empty() || shape.kind == Panel::Kind::label) return;
    const auto same = [&](const Panel::Shape* entry) { return entry->text == shape.text; };
    if (std::none_of(legend_.begin(), legend_.end(), same)) legend_.push_back(&shape);
  }

  /// Bands of equal height with their bounds. @return its right border
  double colour_bar(const Eigen::Vector2d& corner, double bottom) {
    const ColourBar& bar = *figure_.colour_bar;
    const double height = std::clamp(bottom - corner.y(), 120.0, 300.0);
    const auto count = static_cast<int>(bar.bands.size());
    const double step = height / (2 * count + 1);
    double width = 0.0;
    for (int band = count; band >= -count; --band) {
      const double y = corner.y() + step * (count - band);
      svg_ += "<rect x=\"" + px(corner.x()) + "\" y=\"" + px(y) + "\" width=\"16\" height=\"" +
              px(step + 0.5) + "\" fill=\"" + colour_of_band(band, bar.bands.size()) + "\"/>\n";
      if (band == -count) break;
      const std::size_t bound = static_cast<std::size_t>(band > 0 ? band - 1 : -band);
      const std::string number = (band > 0 ? "+" : "−") + px(bar.bands[bound] / bar.unit);
      text(corner.x() + 24.0, y + step + 4.5, number);
      width = std::max(width, text_width(number));
    }
    svg_ += "<rect x=\"" + px(corner.x()) + "\" y=\"" + px(corner.y()) +
            "\" width=\"16\" height=\"" + px(height) + "\" fill=\"none\" stroke=\"#444444\"/>\n";
    const double x = corner.x() + 24.0 + width + 26.0;
    const double y = corner.y() + height / 2.0;
    text(x, y, bar.label,
         " text-anchor=\"middle\" transform=\"rotate(-90 " + px(x) + ' ' + px(y) + ")\"");
    return x + 6.0;
  }

  /// Legend, notes and bars. @return the lower right corner
  Eigen::Vector2d column(const Eigen::Vector2d& corner) {
    double y = corner.y();
    double width = 0.0;
    for (const Panel::Shape* entry : legend_) {
      legend_sign(*entry, corner.x(), y - 4.5);
      text(corner.x() + 34.0, y, entry->text);
      width = std::max(width, 34.0 + text_width(entry->text));
      y += line_height;
    }
    if (!legend_.empty()) y += 0.6 * line_height;
    for (const std::string& note : figure_.notes) {
      if (!note.empty()) text(corner.x(), y, note);
      width = std::max(width, text_width(note));
      y += note.empty() ? 0.5 * line_height : line_height;
    }
    double largest = 0.0;
    for (const Bar& bar : figure_.bars) largest = std::max(largest, bar.value);
    for (const Bar& bar : figure_.bars) {
      constexpr double longest = 90.0;  // [px]
      const double length = largest > 0.0 ? longest * bar.value / largest : 0.0;
      svg_ += "<rect x=\"" + px(corner.x()) + "\" y=\"" + px(y - 10.0) + "\" width=\"" +
              px(length) + "\" height=\"11\" fill=\"#0072b2\"/>\n";
      text(corner.x() + longest + 8.0, y, bar.text);
      width = std::max(width, longest + 8.0 + text_width(bar.text));
      y += line_height;
    }
    return {corner.x() + width, y - line_height};
  }

  void legend_sign(const Panel::Shape& entry, double x, double y) {
    if (entry.kind == Panel::Kind::marker) {
      svg_ += "<circle cx=\"" + px(x + 12.0) + "\" cy=\"" + px(y) + "\" r=\"5.5\"" +
              attributes(entry.style) + "/>\n";
    } else if (entry.style.fill != "none") {
      svg_ += "<rect x=\"" + px(x) + "\" y=\"" + px(y - 6.0) + "\" width=\"24\" height=\"12\"" +
              attributes(entry.style) + "/>\n";
    } else {
      svg_ += "<path d=\"M" + px(x) + ' ' + px(y) + "h24\"" + attributes(entry.style) + "/>\n";
    }
  }

  const Figure& figure_;
  std::string svg_;
  std::vector<const Panel::Shape*> legend_;
  int clips_ = 0;
};

std::string to_svg(const Figure& figure) { return SvgWriter(figure).write(); }

std::string diverging_colour(double value) {
  constexpr std::array<std::array<int, 3>, 11> anchors = {{{0x67, 0x00, 0x1f},
                                                           {0xb2, 0x18, 0x2b},
                                                           {0xd6, 0x60, 0x4d},
                                                           {0xf4, 0xa5, 0x82},
                                                           {0xfd, 0xdb, 0xc7},
                                                           {0xf7, 0xf7, 0xf7},
                                                           {0xd1, 0xe5, 0xf0},
                                                           {0x92, 0xc5, 0xde},
                                                           {0x43, 0x93, 0xc3},
                                                           {0x21, 0x66, 0xac},
                                                           {0x05, 0x30, 0x61}}};
  const double place = (std::clamp(value, -1.0, 1.0) + 1.0) / 2.0 * 10.0;
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), 9);
  const double share = place - static_cast<double>(below);
  std::string colour = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const double mixed = (1.0 - share) * anchors[below][i] + share * anchors[below + 1][i];
    const auto byte = static_cast<unsigned>(std::lround(mixed));
    colour += "0123456789abcdef"[byte / 16];
    colour += "0123456789abcdef"[byte % 16];
  }
  return colour;
}

std::vector<double> colour_bands(double least, double largest) {
  std::vector<double> bands;
  for (double decade = 1e-3; decade < 1e3; decade *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double bound = factor * decade;
      if (bound < least * (1.0 - 1e-9)) continue;
      if (bound >= largest && !bands.empty()) return bands;
      bands.push_back(bound);
    }
  }
  return bands;
}

std::string band_colour(double value, const std::vector<double>& bands) {
  return colour_of_band(band_of(value, bands), bands.size());
}

}  // namespace excavplan::tools
