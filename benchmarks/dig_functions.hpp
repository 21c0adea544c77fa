// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/search_functions.hpp"

/// @file
/// The efficiency of a real dig in the built-in simulator as a function of the unit cube.

namespace excavplan {

/// One soil and one ground.
struct DigCondition {
  double density = 0.0;  ///< [%]
  double rise = 0.0;     ///< of the ground away from the machine [-]
  long scanned = 0;      ///< digs examined for the maximum
  double maximum = 0.0;  ///< best of them [kg/J]

  std::string name() const;
  /// Every seed flips other axes, so that no optimiser profits from its start.
  functions::Function function(std::uint64_t seed) const;
};

/// d = 10, 40 and 80 % on level ground and on a slope of 15 degrees with their maxima, from the
/// file if it exists, or else scanned and written to it: a grid of `grid`^3 digs, then, around the
/// five best in turn, four grids of 9^3 digs, each half as wide as the one before.
std::vector<DigCondition> dig_conditions(const std::string& file, int grid);

}  // namespace excavplan
