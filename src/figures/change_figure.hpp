// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/change/volume_change.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// What the figure of a survey shows.
struct ChangeSheet {
  VolumeChange change;
  std::vector<HeightMap> before;   ///< of each area, on its grid; empty: no sections
  std::vector<std::string> lines;  ///< of the result
  std::vector<Warning> warnings;
};

/// Height change of each surveyed area where its zones are, sections through hole and heap with the
/// band of a cell's noise.
Figure height_change_figure(const ChangeSheet& sheet);

/// The result, what is open, what was left out, warnings, and the standard deviation of the bulking
/// factor by source.
std::vector<std::string> change_table(const ChangeSheet& sheet);

}  // namespace excavplan
