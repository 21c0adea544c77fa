// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "figures/dug_dig.hpp"
#include "inputs/plots.hpp"

namespace excavplan::tools {

/// section, forces, torques, power and, of a machine with cylinders, cylinders.
/// @param machine  that digs, as the command line names it; asked where a figure depends on it
FigureTable<DugDig> dig_figures(const std::function<Machine()>& machine);

}  // namespace excavplan::tools
