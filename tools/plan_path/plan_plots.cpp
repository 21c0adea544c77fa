// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_path/plan_plots.hpp"

#include <filesystem>

#include "inputs/dig_plots.hpp"
#include "report/dig_report.hpp"

namespace excavplan::tools {
namespace {

/// Warns of pictures of an earlier plan, which must not be taken for that of this ground, which has
/// none.
void warn_of_old(const Plots& plots, Outcome& outcome) {
  for (const Plots::File& plot : plots.files) {
    std::error_code unknown;
    if (!std::filesystem::exists(plot.file, unknown)) continue;
    outcome.warnings.emplace_back(WarningCode::plot_not_written,
                                  plot.file + ": is of an earlier run, as there is no dig to draw");
  }
}

}  // namespace

FigureTable<DrawnPlan> plan_figures(const Arguments::Use& searches,
                                    const std::function<Machine()>& machine) {
  FigureTable<DrawnPlan> figures;
  for (const NamedFigure<DugDig>& figure : dig_figures(machine)) {
    figures.push_back(
        {figure.name, [draw = figure.draw](const DrawnPlan& drawn) { return draw(*drawn.dug); }});
  }
  figures.push_back({{"search", "worth of the digs of --search", searches}, search_figure});
  figures.push_back(
      {{"landscape", "worth around the dig that --search found", searches}, landscape_figure});
  return figures;
}

void draw_plan(const Plots& plots, const std::optional<std::string>& report, DrawnPlan drawn,
               Outcome& outcome) {
  if (plots.files.empty() && !report) return;
  const PlanSite& site = drawn.site;
  const DigPlan& plan = drawn.plan;
  std::optional<DigResult> dig;
  if (plan.dig) {
    dig = rehearse(drawn.machine, plan, site);
    const DugDig dug = {drawn.machine,
                        plan.path,
                        *dig,
                        boom_plane_profile(site.ground),
                        boom_plane_profile(dig->after(site.ground)),
                        plan_title(plan, site)};
    drawn.dug = &dug;
    write_plots(plots, plan_figures({}, {}), drawn, outcome.lines, outcome.warnings);
  } else if (!plan.stopped) {
    warn_of_old(plots, outcome);
  }
  if (report) outcome.page = page_of(plan_report(drawn.machine, plan, site, dig), *report);
}

std::vector<MapName> plan_map_names() {
  std::vector<MapName> names = ground_map_names(4);
  names.push_back({"footprint", "1 where the dig lowers the ground"});
  names.push_back({"path", "path of the tip and outline of the cut, as .dxf or .ply", 0});
  return names;
}

}  // namespace excavplan::tools
