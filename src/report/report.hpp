// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "report/report_job.hpp"
#include "report/report_scene.hpp"
#include "report/reported_run.hpp"

/// @file
/// The page that --report writes (docs/report.md).

namespace excavplan {

struct Figure;

/// What a page is about, beside the run.
struct Report {
  std::string title;
  std::vector<std::string> headline;  ///< keys of the result that come first, "cycle.energy_kj"
  std::string plot;  ///< SVG; on paper and where nothing can be drawn in three dimensions
  std::string narrow_plot = {};  ///< the same for a phone; empty: the plot, made smaller
  bool plot_always = false;      ///< the plot shows what nothing else on the page does
  ReportScene scene = {};
  std::optional<ReportJob> job = {};  ///< that the page is about, in place of a scene
  std::string state = {};             ///< "Not finished: ..."; empty: as the run says
  bool is_done = false;               ///< that state is the one that was wanted
  std::string fault = {};             ///< "The dig stalled."; empty if nothing failed
  std::string note = {};              ///< what ground and loads of the scene are
  /// Address of the events that keep a page about a job up to date; empty: it stays as it is.
  std::string stream = {};
};

/// Lays a figure out for the page, and for a phone.
void set_plot(Report& report, const Figure& figure);

/// What of a page changes as its job goes on, for data/report/app/live.js: HTML by the name of the
/// part, and the result.
nlohmann::ordered_json changing_parts(const Report& report, const ReportedRun& run);

/// One page of HTML with all that it needs inside: it loads nothing, but for its stream, and runs
/// no script but its own, whatever the texts in it. Equal arguments give equal bytes.
/// @throws Error (bad_file) if data/report cannot be read
std::string html_page(const Report& report, const ReportedRun& run);

}  // namespace excavplan
