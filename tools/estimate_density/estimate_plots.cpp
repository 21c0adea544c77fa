// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/estimate_plots.hpp"

#include "figures/density_figure.hpp"
#include "report/dig_report.hpp"

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
  if (report) outcome.page = page_of(survey_report(drawn.sheet), *report);
}

}  // namespace excavplan::tools
