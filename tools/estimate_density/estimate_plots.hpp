// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/density/density_estimate.hpp>

#include "figures/change_figure.hpp"
#include "frame/tool.hpp"
#include "inputs/plots.hpp"

namespace excavplan::tools {

/// An estimate as its figures show it.
struct DrawnEstimate {
  const DensityEstimate& estimate;
  ChangeSheet sheet;
};

/// change and density.
const FigureTable<DrawnEstimate>& estimate_figures();

/// Writes the figures of an estimate that were asked for and adds the page about it to the outcome
/// if there is a file for it.
void draw_estimate(const Plots& plots, const std::optional<std::string>& report,
                   const DensityEstimate& estimate, Outcome& outcome);

}  // namespace excavplan::tools
