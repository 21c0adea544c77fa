// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/soil/density_law.hpp>

/// @file
/// The density in a result of estimate-density --json: of --density-from and --prior.

namespace excavplan {

/// Of a standard deviation of density; ours [points]: long before, any density is as likely.
inline constexpr double most_density_sd = 1000.0;

/// What is taken of a result of estimate-density.
struct StatedDensity {
  GroundDensity density;              ///< with its standard deviation
  double raw_percent = 0.0;           ///< also outside 0 .. 100
  double independent_sd = 0.0;        ///< part of its sd that is not of the law [points]
  bool of_any_soil = false;           ///< by --soil unknown
  bool is_whole = false;              ///< it states the tool, and then all that the tool does
  std::vector<Rectangle> holes{};     ///< that it was measured in
  std::vector<double> volumes{};      ///< of hole, spill and heap [m^3]
  std::optional<double> excavated{};  ///< of the hole alone [m^3]
};

/// @throws Error (bad_file) naming file, key, value and rule
StatedDensity stated_density(const std::string& file);

/// Code density_from_elsewhere: where it is used is more than 5 m (ours) from its holes.
std::optional<Warning> elsewhere(const StatedDensity& stated, const std::string& file,
                                 const Rectangle& here);

/// Code ground_before_dig: the ground, as far as it shows the holes and half a metre about them,
/// lies lower there by less than a third of what was dug (ours): it was scanned before that dig.
std::optional<Warning> older_ground(const StatedDensity& stated, const std::string& file,
                                    const HeightMap& ground);

}  // namespace excavplan
