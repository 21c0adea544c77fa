// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/render.hpp"

#include <charconv>
#include <filesystem>
#include <memory>
#include <new>

#ifdef EXCAVPLAN_WITH_CAIRO
#include <cairo-pdf.h>
#include <cairo.h>
#include <fontconfig/fontconfig.h>
#endif

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

std::string ending_of(const std::string& file) {
  return small_letters(std::filesystem::path(file).extension().string());
}

#ifdef EXCAVPLAN_WITH_CAIRO
constexpr double dots_per_inch = 300.0;

struct Free {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* page) const { cairo_destroy(page); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
using Surface = std::unique_ptr<cairo_surface_t, Free>;
using Page = std::unique_ptr<cairo_t, Free>;

void require(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  throw Error(ErrorKind::bad_input,
              std::string("the plot cannot be drawn: ") + cairo_status_to_string(status));
}

double channel(const std::string& colour, std::size_t place) {
  int value = 0;
  std::from_chars(colour.data() + place, colour.data() + place + 2, value, 16);
  return value / 255.0;
}

/// Draws the items of a drawing one after the other.
class Painter {
 public:
  explicit Painter(cairo_t* page) : page_(page) {
    const std::unique_ptr<cairo_font_options_t, Free> options(cairo_font_options_create());
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(page_, options.get());
    cairo_set_line_join(page_, CAIRO_LINE_JOIN_ROUND);
  }

  void operator()(const DrawnPath& path) {
    for (const Points& part : path.parts) {
      for (std::size_t i = 0; i < part.size(); ++i) {
        (i == 0 ? cairo_move_to : cairo_line_to)(page_, part[i].x(), part[i].y());
      }
      if (path.closed) cairo_close_path(page_);
    }
    paint(path.style);
  }

  void operator()(const DrawnCircle& circle) {
    cairo_new_sub_path(page_);
    cairo_arc(page_, circle.centre.x(), circle.centre.y(), circle.radius, 0.0, 2.0 * pi);
    paint(circle.style);
  }

  void operator()(const DrawnCells& cells) {
    cairo_set_antialias(page_, CAIRO_ANTIALIAS_NONE);
    for (const Box& box : cells.boxes) {
      cairo_rectangle(page_, box.left, box.top, box.width, box.height);
    }
    set_colour(cells.colour, 1.0);
    cairo_fill(page_);
    cairo_set_antialias(page_, CAIRO_ANTIALIAS_DEFAULT);
  }

  void operator()(const DrawnText& text) {
    cairo_select_font_face(page_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           text.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(page_, text.size);
    cairo_text_extents_t extents;
    cairo_text_extents(page_, text.text.c_str(), &extents);
    const double share =
        text.anchor == Anchor::start ? 0.0 : (text.anchor == Anchor::middle ? 0.5 : 1.0);
    cairo_save(page_);
    cairo_translate(page_, text.at.x(), text.at.y());
    if (text.upright) cairo_rotate(page_, -pi / 2.0);
    cairo_move_to(page_, -share * extents.x_advance, 0.0);
    if (text.halo) {
      cairo_text_path(page_, text.text.c_str());
      cairo_set_line_width(page_, 2.0);
      set_colour("#ffffff", 1.0);
      cairo_stroke(page_);
      cairo_move_to(page_, -share * extents.x_advance, 0.0);
    }
    set_colour(text.colour, 1.0);
    cairo_show_text(page_, text.text.c_str());
    cairo_restore(page_);
    cairo_new_path(page_);
  }

  void operator()(const Clip& clip) {
    cairo_reset_clip(page_);
    if (!(clip.box.width > 0.0)) return;
    cairo_rectangle(page_, clip.box.left, clip.box.top, clip.box.width, clip.box.height);
    cairo_clip(page_);
  }

 private:
  void set_colour(const std::string& colour, double opacity) {
    cairo_set_source_rgba(page_, channel(colour, 1), channel(colour, 3), channel(colour, 5),
                          opacity);
  }

  void paint(const Style& style) {
    if (style.fill != "none") {
      set_colour(style.fill, style.opacity);
      cairo_fill_preserve(page_);
    }
    if (style.stroke != "none") {
      set_colour(style.stroke, style.opacity);
      cairo_set_line_width(page_, style.width);
      cairo_set_dash(page_, style.dash.data(), static_cast<int>(style.dash.size()), 0.0);
      cairo_stroke_preserve(page_);
      cairo_set_dash(page_, nullptr, 0, 0.0);
    }
    cairo_new_path(page_);
  }

  cairo_t* page_;
};

cairo_status_t append(void* content, const unsigned char* bytes, unsigned count) {
  try {
    static_cast<std::string*>(content)->append(bytes, bytes + count);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void draw(const Drawing& drawing, cairo_surface_t* surface, double scale) {
  const Page page(cairo_create(surface));
  require(cairo_status(page.get()));
  cairo_set_source_rgb(page.get(), 1.0, 1.0, 1.0);
  cairo_paint(page.get());
  cairo_scale(page.get(), scale, scale);
  Painter painter(page.get());
  for (const DrawnItem& item : drawing.items) std::visit(painter, item);
  require(cairo_status(page.get()));
  cairo_show_page(page.get());
}

std::string png(const Drawing& drawing) {
  const double scale = dots_per_inch / 72.0;
  const auto dots = [&](double length) { return static_cast<int>(std::lround(scale * length)); };
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, dots(drawing.width), dots(drawing.height)));
  require(cairo_surface_status(surface.get()));
  draw(drawing, surface.get(), scale);
  std::string content;
  require(cairo_surface_write_to_png_stream(surface.get(), append, &content));
  return content;
}

std::string pdf(const Drawing& drawing) {
  std::string content;
  const Surface surface(
      cairo_pdf_surface_create_for_stream(append, &content, drawing.width, drawing.height));
  require(cairo_surface_status(surface.get()));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, drawing.title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  draw(drawing, surface.get(), 1.0);
  cairo_surface_finish(surface.get());
  require(cairo_surface_status(surface.get()));
  return content;
}

// Without a font, cairo draws one of its own without most letters.
void require_fonts() {
  const FcFontSet* fonts = FcConfigGetFonts(nullptr, FcSetSystem);
  if (fonts != nullptr && fonts->nfont > 0) return;
  throw Error(ErrorKind::bad_input,
              "no font is installed, which PNG and PDF need for their texts; install one, "
              "such as fonts-dejavu-core, or write .svg");
}
#else
[[noreturn]] void require_fonts() {
  throw Error(ErrorKind::bad_input,
              "PNG and PDF need cairo, which this program was built without; build it where "
              "pkg-config, libcairo2-dev and libfontconfig-dev are installed, or write .svg");
}
std::string png(const Drawing& /*drawing*/) { require_fonts(); }
std::string pdf(const Drawing& /*drawing*/) { require_fonts(); }
#endif

}  // namespace

const std::vector<std::string>& image_endings() {
  static const std::vector<std::string> endings = {".svg", ".png", ".pdf"};
  return endings;
}

void require_fonts(const std::string& file) {
  if (ending_of(file) != ".svg") require_fonts();
}

std::string image_of(const Drawing& drawing, const std::string& file) {
  if (ending_of(file) == ".svg") return to_svg(drawing);
  require_fonts();
  return ending_of(file) == ".png" ? png(drawing) : pdf(drawing);
}

}  // namespace excavplan
