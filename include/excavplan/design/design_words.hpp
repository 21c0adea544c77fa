// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include <excavplan/design/design_surface.hpp>
#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// What a design is in words.
enum class DesignKind {
  trench,  ///< a floor with walls around it
  pit,     ///< the same, mostly wider
  slope,   ///< a face that rises to the left of a line, and a floor to the right of it
};

/// A trench, a pit or the cut of a slope along a line.
struct DesignWords {
  DesignKind kind = DesignKind::trench;  ///< trench, pit or slope
  double length = 0.0;                   ///< of the floor along the line [m], > 0
  double floor_width = 0.0;              ///< of a slope, to the right of the line [m], > 0
  /// Of the floor in the middle of the line, below the mean of the ground along it [m].
  std::optional<double> depth = {};
  std::optional<double> floor_z = {};  ///< of that place instead [m]
  Eigen::Vector2d from = {0.0, 0.0};   ///< where the line begins, mostly at the machine [m]
  double heading = 0.0;                ///< of the line, from x to y [rad]
  double grade = 0.0;                  ///< of the floor along it, > 0 rises [-]
  double batter = 0.0;  ///< of walls and faces, horizontal per vertical [-], >= 0; 0: upright
};

/// Reads "15x1x0.5": length, width and depth of a trench, in m, or in the unit behind it: "m",
/// "cm", "mm", "ft". @throws Error (bad_input) if it is none
DesignWords trench_of_size(const std::string& size);

/// The surface of words on this ground. Walls end where they reach the ground.
/// @throws Error (bad_input) if a number is out of range; if the depth counts from the ground and
/// none is known along the line
DesignSurface design_of_words(const DesignWords& words, const HeightMap& ground);

}  // namespace excavplan
