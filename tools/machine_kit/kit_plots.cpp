// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine_kit/kit_plots.hpp"

#include "figures/joints_figure.hpp"
#include "figures/measures_figure.hpp"
#include "figures/reach_figure.hpp"

namespace excavplan::tools {

const FigureTable<Machine>& kit_figures() {
  static const FigureTable<Machine> figures = {
      {{"joints", "the machine as understood: its joints at zero, their ranges and directions"},
       joints_figure},
      {{"measures", "its pins, lengths, ranges and the profile of the bucket"}, measures_figure},
      {{"reach", "the machine, how far its tip comes and how hard it digs there"}, reach_figure}};
  return figures;
}

}  // namespace excavplan::tools
