// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/report_scene.hpp"
#include "frame/tool.hpp"

/// @file
/// The page that --report writes (docs/report.md).

namespace excavplan::tools {

/// What a tool adds to its outcome for a page about it.
struct Report {
  std::string file;  ///< to write
  std::string title;
  std::vector<std::string> headline;  ///< keys of the result that come first, "cycle.energy_kj"
  std::string plot;          ///< SVG; on paper and where nothing can be drawn in three dimensions
  bool plot_always = false;  ///< the plot shows what nothing else on the page does
  ReportScene scene = {};
  std::string fault = {};  ///< "The dig stalled."; empty if nothing failed
  std::string note = {};   ///< what ground and loads of the scene are
};

/// Complete, for Outcome::report.
std::shared_ptr<const Report> titled(Report report, const std::string& file,
                                     const std::string& title, const std::string& plot);

/// An option or an input with the value that counted.
struct Setting {
  std::string name;
  std::string value;
  bool given = false;  ///< else it is the default
};

/// The run that a page is about.
struct ReportedRun {
  std::string tool;
  std::string version;
  std::string json;  ///< as --json prints it
  std::vector<std::string> lines;
  std::vector<Warning> warnings;
  bool judged = false;  ///< the tool can find its result not trustworthy
  bool trustworthy = true;
  bool stopped_early = false;
  std::vector<Setting> settings;
};

/// One page of HTML with all that it needs inside: it loads nothing and runs no script but its own,
/// whatever the texts in it. Equal arguments give equal bytes.
/// @throws Error (bad_file) if data/report cannot be read
std::string html_page(const Report& report, const ReportedRun& run);

/// Every number of a result in tables, with its unit, standard deviation and interval.
std::string figure_tables(const nlohmann::ordered_json& result);
/// Those of the keys that the result has, as tiles.
std::string headline_tiles(const nlohmann::ordered_json& result,
                           const std::vector<std::string>& keys);

}  // namespace excavplan::tools
