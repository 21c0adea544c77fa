// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate_density/calibration_plots.hpp"

#include "figures/law_figure.hpp"

namespace excavplan::tools {

const FigureTable<DensityCalibration>& calibration_figures() {
  static const FigureTable<DensityCalibration> figures = {
      {{"law", "samples, the forms fitted to them and the scatter"}, law_figure}};
  return figures;
}

}  // namespace excavplan::tools
