// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/rehearsal.hpp>

#include "drawing/plot.hpp"
#include "figures/dug_dig.hpp"

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

}  // namespace excavplan
