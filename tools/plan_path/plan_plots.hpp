// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "figures/plan_figures.hpp"
#include "frame/tool.hpp"
#include "inputs/plots.hpp"

namespace excavplan::tools {

/// dig_figures(), search and landscape. @param searches  whether plan-path does
FigureTable<DrawnPlan> plan_figures(const Arguments::Use& searches,
                                    const std::function<Machine()>& machine);

/// Writes the figures that were asked for and adds the page about the plan to the outcome if there
/// is a file for it. Without a dig there is only the page.
void draw_plan(const Plots& plots, const std::optional<std::string>& report, DrawnPlan drawn,
               Outcome& outcome);

}  // namespace excavplan::tools
