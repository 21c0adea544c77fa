// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <excavplan/base/warning.hpp>

#include "drawing/plot.hpp"
#include "frame/arguments.hpp"

/// @file
/// The options --plot, --plot-size and --plot-table of every tool that draws. A tool has a table of
/// its figures; the first that is possible is the one that --plot FILE draws.

namespace excavplan::tools {

/// A figure of a tool as the command line knows it.
struct FigureName {
  std::string name;              ///< "section"
  std::string help;              ///< "the dig in the plane of the boom"
  Arguments::Use possible = {};  ///< asked once all options are read; empty: always
};

/// What the options say.
struct Plots {
  struct File {
    std::string figure;  ///< its name
    std::string file;
  };
  std::vector<File> files;
  SheetSize size;
  bool table = false;

  bool has(const std::string& figure) const;
};

void declare_plots(Arguments& arguments, Plots& plots, const std::vector<FigureName>& figures);

/// Draws a figure into a file of its ending.
/// @param table  for --plot-table
/// @param warnings  get what --plot-size has no room for
void write_plot(const Plots& plots, const std::string& file, Figure figure,
                const std::vector<std::string>& table, std::vector<Warning>& warnings);

/// How a figure with a name is drawn.
template <typename Subject>
struct NamedFigure {
  FigureName name;
  std::function<Figure(const Subject& subject)> draw;
};

template <typename Subject>
using FigureTable = std::vector<NamedFigure<Subject>>;

template <typename Subject>
std::vector<FigureName> names_of(const FigureTable<Subject>& table) {
  std::vector<FigureName> names;
  for (const NamedFigure<Subject>& figure : table) names.push_back(figure.name);
  return names;
}

/// Draws what the options ask for; as write_plot().
template <typename Subject>
void write_plots(const Plots& plots, const FigureTable<Subject>& figures, const Subject& subject,
                 const std::vector<std::string>& table, std::vector<Warning>& warnings) {
  for (const Plots::File& each : plots.files) {
    for (const NamedFigure<Subject>& figure : figures) {
      if (figure.name.name != each.figure) continue;
      write_plot(plots, each.file, figure.draw(subject), table, warnings);
    }
  }
}

}  // namespace excavplan::tools
