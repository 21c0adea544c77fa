// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/drawing.hpp"

#include <charconv>

namespace excavplan {
namespace {

/// Advances of the characters 32 .. 126 of DejaVu Sans [1/1000 of the size].
constexpr std::array<int, 95> advances = {
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
constexpr double foreign_advance = 0.65;  // of characters beyond ASCII, such as a minus or a cube
constexpr double bold_excess = 1.13;

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + '"';
}

/// A coordinate [pt].
std::string pt(double value) { return short_number(value, 2); }

std::string attribute(const char* name, double value) { return attribute(name, pt(value)); }

std::string attributes(const Style& style) {
  std::string text = attribute("fill", style.fill) + attribute("stroke", style.stroke);
  if (style.stroke != "none") text += attribute("stroke-width", style.width);
  if (style.opacity < 1.0) text += attribute("opacity", style.opacity);
  std::string dash;
  for (const double length : style.dash) dash += (dash.empty() ? "" : " ") + pt(length);
  if (!dash.empty()) text += attribute("stroke-dasharray", dash);
  return text;
}

std::string svg(const DrawnPath& path) {
  std::string d;
  for (const Points& part : path.parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      d += (i == 0 ? "M" : "L") + pt(part[i].x()) + ' ' + pt(part[i].y());
    }
    if (path.closed) d += 'Z';
  }
  return d.empty() ? "" : "<path" + attribute("d", d) + attributes(path.style) + "/>\n";
}

std::string svg(const DrawnCircle& circle) {
  return "<circle" + attribute("cx", circle.centre.x()) + attribute("cy", circle.centre.y()) +
         attribute("r", circle.radius) + attributes(circle.style) + "/>\n";
}

std::string svg(const DrawnCells& cells) {
  std::string d;
  for (const Box& box : cells.boxes) {
    d += "M" + pt(box.left) + ' ' + pt(box.top) + 'H' + pt(box.right()) + 'V' + pt(box.bottom()) +
         'H' + pt(box.left) + 'z';
  }
  return "<path shape-rendering=\"crispEdges\"" + attribute("fill", cells.colour) +
         attribute("d", d) + "/>\n";
}

std::string svg(const DrawnText& text) {
  std::string more = attribute("font-size", text.size);
  if (text.anchor != Anchor::start) {
    more += attribute("text-anchor", text.anchor == Anchor::middle ? "middle" : "end");
  }
  if (text.bold) more += attribute("font-weight", "bold");
  if (text.colour != DrawnText{}.colour) more += attribute("fill", text.colour);
  if (text.halo) {
    more +=
        " stroke=\"#ffffff\" stroke-width=\"2\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
  }
  if (text.upright) {
    more += attribute("transform", "rotate(-90 " + pt(text.at.x()) + ' ' + pt(text.at.y()) + ')');
  }
  return "<text" + attribute("x", text.at.x()) + attribute("y", text.at.y()) + more + '>' +
         xml_escaped(text.text) + "</text>\n";
}

/// Opens and closes the groups that are clipped.
class Clips {
 public:
  std::string begin(const Box& box) {
    std::string text = end();
    if (!(box.width > 0.0)) return text;
    const std::string id = "clip" + std::to_string(count_++);
    open_ = true;
    return text + "<clipPath id=\"" + id + "\"><rect" + attribute("x", box.left) +
           attribute("y", box.top) + attribute("width", box.width) +
           attribute("height", box.height) + "/></clipPath>\n<g clip-path=\"url(#" + id + ")\">\n";
  }
  std::string end() {
    const bool was_open = open_;
    open_ = false;
    return was_open ? "</g>\n" : "";
  }

 private:
  int count_ = 0;
  bool open_ = false;
};

}  // namespace

std::string short_number(double value, int decimals) {
  std::array<char, 400> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  std::string text(buffer.data(), end);
  if (decimals > 0) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

double text_width(const std::string& text, double size, bool bold) {
  double width = 0.0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 32 && byte < 127) {
      width += advances[byte - 32U] / 1000.0;
    } else if ((byte & 0xC0U) != 0x80U) {
      width += foreign_advance;
    }
  }
  return width * size * (bold ? bold_excess : 1.0);
}

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

std::string to_svg(const Drawing& drawing) {
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\"" +
                     attribute("width", pt(drawing.width / points_per_mm) + "mm") +
                     attribute("height", pt(drawing.height / points_per_mm) + "mm") +
                     attribute("viewBox", "0 0 " + pt(drawing.width) + ' ' + pt(drawing.height)) +
                     " font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\"" +
                     " stroke-linejoin=\"round\"" + attribute("fill", DrawnText{}.colour) + ">\n";
  if (!drawing.title.empty()) text += "<title>" + xml_escaped(drawing.title) + "</title>\n";
  text += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  Clips clips;
  for (const DrawnItem& item : drawing.items) {
    if (const auto* clip = std::get_if<Clip>(&item)) {
      text += clips.begin(clip->box);
      continue;
    }
    std::visit(
        [&](const auto& drawn) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(drawn)>, Clip>) text += svg(drawn);
        },
        item);
  }
  return text + clips.end() + "</svg>\n";
}

}  // namespace excavplan
