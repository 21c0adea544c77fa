// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/plots.hpp"

#include <algorithm>
#include <cmath>

#include "base/files.hpp"
#include "base/text.hpp"
#include "drawing/render.hpp"
#include "frame/named_file.hpp"
#include "frame/option_names.hpp"

namespace excavplan::tools {
namespace {

constexpr double least_size = 40.0;  // [mm]
constexpr double most_size = 500.0;  // [mm]

bool is_possible(const FigureName& figure) {
  return !figure.possible.holds || figure.possible.holds();
}

/// Nothing for the main figure.
const FigureName* named(const std::string& text, const std::vector<FigureName>& figures) {
  const NamedFile words = named_file(text);
  if (words.file.empty()) usage_error("--plot: " + text + " names no file");
  if (text.front() == '=') usage_error("--plot: " + text + " has an empty name before its '='");
  if (words.name.empty()) return nullptr;
  const auto same = [&](const FigureName& figure) { return figure.name == words.name; };
  const auto found = std::find_if(figures.begin(), figures.end(), same);
  if (found != figures.end()) return &*found;
  std::string all;
  for (const FigureName& figure : figures) all += (all.empty() ? "" : ", ") + figure.name;
  usage_error("--plot: there is no figure '" + words.name + "', expected one of " + all);
}

const FigureName& figure_of(const std::string& text, const std::vector<FigureName>& figures) {
  const FigureName* figure = named(text, figures);
  if (figure == nullptr) {
    const auto first = std::find_if(figures.begin(), figures.end(), is_possible);
    figure = first == figures.end() ? &figures.front() : &*first;
  }
  if (is_possible(*figure)) return *figure;
  usage_error("--plot: no figure '" + figure->name + "': " + figure->possible.otherwise);
}

double side(const std::string& text) {
  const double length = 1000.0 * parse_quantity("--plot-size", text, Quantity::length);
  if (length >= least_size * (1.0 - 1e-9) && length <= most_size * (1.0 + 1e-9)) return length;
  const bool bare = text.find_first_not_of("+-.0123456789") == std::string::npos;
  usage_error("--plot-size: " + text + (bare ? " m" : "") + " must be 40mm .. 500mm" +
              (bare ? "; " + text + "mm is in millimetres" : ""));
}

SheetSize sheet_size(const std::string& text) {
  const std::vector<std::string> sides = split(text, ',');
  if (sides.size() > 2) {
    usage_error("--plot-size: '" + text + "' must be a width, or width,height");
  }
  SheetSize size{side(sides[0]), {}};
  if (sides.size() == 2) size.height = side(sides[1]);
  return size;
}

std::string help_of(const std::vector<FigureName>& figures) {
  std::string help = "draw a figure into this file; NAME:";
  for (const FigureName& figure : figures) {
    help += (help.back() == ':' ? " " : "; ") + figure.name + ", " + figure.help +
            (&figure == &figures.front() ? " (default)" : "");
  }
  return help + ". May be given several times";
}

Warning left_out_warning(const std::string& file, const Drawing& drawing) {
  std::string parts;
  for (const std::string& part : drawing.left_out) parts += (parts.empty() ? "" : ", ") + part;
  const auto mm = [](double points) { return decimals(std::ceil(points / points_per_mm), 0); };
  return {WarningCode::plot_left_out, file + ": --plot-size has no room for " + parts +
                                          "; a height of " + mm(drawing.needed_height) + " mm has"};
}

}  // namespace

bool Plots::has(const std::string& figure) const {
  return std::any_of(files.begin(), files.end(),
                     [&](const File& file) { return file.figure == figure; });
}

void declare_plots(Arguments& arguments, Plots& plots, const std::vector<FigureName>& figures) {
  Arguments::Entry plot;
  plot.name = "plot";
  plot.placeholder = "[NAME=]FILE.svg|png|pdf";
  plot.help = help_of(figures);
  plot.output = true;
  plot.repeated = true;
  plot.endings = image_endings();
  plot.file_in = [](const std::string& text) { return named_file(text).file; };
  plot.assign = [figures](const std::string& text) { named(text, figures); };
  plot.check = [&plots, figures](const std::string& text) {
    const std::string file = named_file(text).file;
    plots.files.push_back({figure_of(text, figures).name, file});
    naming_options({{"no font is", "--plot: no font is"},
                    {"PNG and PDF need cairo", "--plot: PNG and PDF need cairo"}},
                   [&] { require_fonts(file); });
  };
  arguments.add(plot);
  arguments.only_if({[&plots] { return !plots.files.empty(); }, "there is no --plot"}, [&] {
    Arguments::Entry size;
    size.name = "plot-size";
    size.placeholder = "LENGTH[,LENGTH]";
    size.default_text = "170mm";
    size.help = "width of the plots, or width and height, that they are laid out for [m]";
    size.assign = [&plots](const std::string& text) { plots.size = sheet_size(text); };
    arguments.add(size);
    arguments.flag("plot-table", plots.table, "put the table of the results below the plots");
  });
}

void write_plot(const Plots& plots, const std::string& file, Figure figure,
                const std::vector<std::string>& table, std::vector<Warning>& warnings) {
  if (plots.table) figure.table = table;
  const Drawing drawing = lay_out(figure, plots.size);
  write_file(file, image_of(drawing, file));
  if (!drawing.left_out.empty()) warnings.push_back(left_out_warning(file, drawing));
}

}  // namespace excavplan::tools
