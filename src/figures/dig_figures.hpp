// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <excavplan/simulation/soil_simulator.hpp>

#include "figures/machine_outline.hpp"
#include "inputs/plots.hpp"

/// @file
/// Figures of one dig.

namespace excavplan {

/// A dig that was simulated, with its history.
struct DugDig {
  const Machine& machine;
  const DigPath& path;
  const DigResult& dig;
  GroundProfile before, after;  ///< ground in the plane of the boom
  std::string title;            ///< of the files
};

/// The whole machine, and the dig: ground before and after, path of the tip by phase, the bucket
/// with its soil at the ends of the phases.
Figure section_figure(const DugDig& dug);

/// Its body and front without the bucket.
void draw_machine(Panel& panel, const MachineOutline& machine);

/// section, forces, torques, power and, of a machine with cylinders, cylinders.
/// @param machine  that digs, as the command line names it; asked where a figure depends on it
FigureTable<DugDig> dig_figures(const std::function<Machine()>& machine);

}  // namespace excavplan
