// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/ground/volume_change.hpp>
#include <excavplan/machine/dig_path.hpp>

/// @file
/// The figures that --plot writes, as SVG text.

namespace excavplan::tools {

/// What the figure of a survey shows.
struct ChangeSheet {
  VolumeChange change;
  std::vector<HeightMap> before;   ///< of each area, on its grid; empty: no sections
  std::vector<std::string> lines;  ///< of the result
  std::vector<Warning> warnings;
};

/// Height change of each surveyed area where its zones are, sections through hole and heap with the
/// band of a cell's noise; beside them the result, what is open, what was left out, warnings, and
/// the standard deviation of the bulking factor by source.
std::string height_change_figure(const ChangeSheet& sheet);

/// Ground in the boom plane, as boom_plane_profile() gives it.
struct DigSection {
  GroundProfile before;
  GroundProfile after = {};  ///< empty if nothing was dug
};

/// Section in the boom plane: ground before and after, path of the tip by phase, the bucket at the
/// ends of the phases, the machine's links at the start.
std::string dig_figure(const Machine& machine, const DigPath& path, const DigSection& ground,
                       const std::string& title, const std::vector<std::string>& notes);

}  // namespace excavplan::tools
