// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_plots.hpp"

#include "figures/density_figure.hpp"
#include "report/report.hpp"

namespace excavplan::tools {

const FigureTable<DrawnEstimate>& estimate_figures() {
  static const FigureTable<DrawnEstimate> figures = {
      {{"change", "height change with its zones, and sections"},
       [](const DrawnEstimate& drawn) { return height_change_figure(drawn.sheet); }},
      {{"density", "density with its 95 % interval, and the law with the measured bulking factor"},
       [](const DrawnEstimate& drawn) { return density_figure(drawn.estimate); }}};
  return figures;
}

void draw_estimate(const Plots& plots, const std::optional<std::string>& report,
                   const DensityEstimate& estimate, Outcome& outcome) {
  const DrawnEstimate drawn = {estimate,
                               {estimate.change, estimate.before, outcome.lines, outcome.warnings}};
  write_plots(plots, estimate_figures(), drawn, change_table(drawn.sheet), outcome.warnings);
  if (!report) return;
  Report page;
  page.headline = {"density_percent", "bulking_factor", "volume.excavated_m3", "volume.spilled_m3",
                   "volume.dumped_m3"};
  page.plot_always = true;
  page.scene.areas = surveyed_areas(estimate.change, estimate.before);
  page.scene.zones = estimate.change.zones;
  page.note =
      "The ground after the dig is that before it plus the height change that was measured.";
  page.title = "Relative density of the ground from two scans";
  page.plot = to_svg(lay_out(height_change_figure(drawn.sheet)));
  outcome.page = page_of(std::move(page), *report);
}

}  // namespace excavplan::tools
