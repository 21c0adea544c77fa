// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "figures/dig_figures.hpp"
#include "report/dig_report.hpp"

/// @file
/// Figures of a planned dig and of the search for it.

namespace excavplan {

/// A plan, and what it was made with.
struct DrawnPlan {
  const Machine& machine;
  const DigPlan& plan;
  const PlanSite& site;
  const DigSearchOptions& search;
  const DugDig* dug = nullptr;  ///< the planned dig, rehearsed; figures need it
};

/// Worth of all digs of a search, and the best so far.
Figure search_figure(const DrawnPlan& drawn);

/// Worth in two sections of the search ranges through the planned dig, with its start: angle and
/// penetration length, penetration length and drag length; some 700 digs in the simulator.
Figure landscape_figure(const DrawnPlan& drawn);

/// dig_figures(), search and landscape. @param searches  whether plan-path does
FigureTable<DrawnPlan> plan_figures(const Arguments::Use& searches,
                                    const std::function<Machine()>& machine);

/// Writes the figures that were asked for and adds the page about the plan to the outcome if there
/// is a file for it. Without a dig there is only the page.
void draw_plan(const Plots& plots, const std::optional<std::string>& report, DrawnPlan drawn,
               Outcome& outcome);

}  // namespace excavplan
