// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "run_experiment/experiment_plots.hpp"

namespace excavplan::tools {

FigureTable<DrawnExperiments> experiment_figures(const Arguments::Use& experiment) {
  return {{{"paths", "paths of the tip, fixed and planned", experiment},
           [](const DrawnExperiments& drawn) { return paths_figure(drawn.experiments); }},
          {{"efficiency", "what both digs of each condition are worth", experiment},
           [](const DrawnExperiments& drawn) { return efficiency_figure(drawn.experiments); }},
          {{"regression", "density over bulking factor, with the paper's line", experiment},
           regression_figure}};
}

}  // namespace excavplan::tools
