// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "measure_efficiency/efficiency_plots.hpp"

namespace excavplan::tools {

FigureTable<DrawnRuns> run_figures(const Arguments::Use& of_logs) {
  return {
      {{"efficiency", "efficiency of each run with its 95 % interval", of_logs}, runs_figure},
      {{"fuel", "fuel flow or power over time, with the dig and idling", of_logs}, rates_figure}};
}

FigureTable<ComparedSets> set_figures(const Arguments::Use& of_sets) {
  return {{{"sets", "every run of both sets, their means and the gain", of_sets}, sets_figure}};
}

}  // namespace excavplan::tools
