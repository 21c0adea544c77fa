// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/dig_plots.hpp"

#include "figures/dig_figures.hpp"
#include "figures/load_figures.hpp"

namespace excavplan::tools {

FigureTable<DugDig> dig_figures(const std::function<Machine()>& machine) {
  const Arguments::Use with_cylinders = {[machine] { return machine().cylinders.has_value(); },
                                         "the file of the machine states no cylinders"};
  return {
      {{"section", "machine, ground and bucket in the plane of the boom"}, section_figure},
      {{"forces", "force of the soil and payload over time"}, forces_figure},
      {{"torques", "torques of the joints with their limits"}, torques_figure},
      {{"power", "power and energy over time"}, power_figure},
      {{"cylinders", "pressures or forces of the cylinders", with_cylinders}, cylinders_figure}};
}

}  // namespace excavplan::tools
