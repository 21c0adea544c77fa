// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "library/library_cells.hpp"

/// @file
/// What is between two entries of a library: what a look-up gives there, what it gives away, and
/// which kind of dig reaches how far.

namespace excavplan {

/// True if the two digs differ so much that they may be of different kinds, and a mix of them
/// neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b);

/// Linear between two digs; with `jump` the nearer one.
PlannedDig dig_between(const PlannedDig& a, const PlannedDig& b, double share, bool jump);

/// The value midway between the middle two of some places, by the polynomial of the logarithm
/// through all of them.
/// @param known  up to four places and their values > 0
double expected_between(const std::vector<std::pair<double, double>>& known, double place);

/// What digging midway between two neighbours told: their mix, and where they are far apart both of
/// them.
struct Midway {
  MidwayError error;  ///< of what is looked up; of two that may be, the larger
  int evaluations = 0;
  /// The neighbour that is better midway by more than half a percent, so that the other one may not
  /// be the best at its own place either; neither too if they are not far apart.
  enum class Better { neither, below, above } better = Better::neither;
  bool jump = false;  ///< the mix is worse than the worse one of the two
};

/// @param best  efficiency of the best dig in the cell
Midway measure_midway(const LibraryCell& midway, double cell_size, const PlannedDig& below,
                      const PlannedDig& above, double best);

/// Between the slope of an entry and the next, at its density.
struct SlopeGap {
  std::size_t entry = 0;  ///< in the library
  double density_percent = 0.0;
  double middle = 0.0;  ///< slope [rad]
  PlannedDig below;
  PlannedDig above;
  double best_expected = 0.0;  ///< efficiency midway [kg/J]
};

/// Of all entries but those of the last slope, and those whose density has no dig on the next.
std::vector<SlopeGap> slope_gaps(const PathLibrary& library);

}  // namespace excavplan
