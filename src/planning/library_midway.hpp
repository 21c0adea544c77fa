// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "library_cells.hpp"

/// @file
/// What is between two entries of a library: what a look-up gives there, what it gives away, and
/// which kind of dig reaches how far.

namespace excavplan {

/// True if the two digs are of different kinds: a blend of them would be neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b);

/// Linear between two digs; the nearer one where they are of different kinds.
PlannedDig blend_digs(const PlannedDig& a, const PlannedDig& b, double share);

/// The value midway between the middle two of some places, by the polynomial of the logarithm
/// through all of them.
/// @param known  up to four places and their values > 0
double expected_between(const std::vector<std::pair<double, double>>& known, double place);

/// A look-up that was dug.
struct MidwayDig {
  MidwayError error;
  double efficiency = 0.0;  ///< [kg/J]; 0 if it cannot be dug
  int evaluations = 0;
};

/// @param best  efficiency of the best dig in the cell
MidwayDig dig_midway(const LibraryCell& midway, double cell_size, const PlannedDig& looked_up,
                     double best);

/// Where two neighbouring densities have digs of different kinds, both were dug midway.
struct MidwayDensity {
  MidwayError error;  ///< the larger of the two
  int evaluations = 0;
  /// The kind that is better midway by more than half a percent, so that the other one may not be
  /// the best at its own density either; 0: neither, or they are of one kind.
  enum class Better { neither, below, above } better = Better::neither;
};

MidwayDensity measure_midway(const LibraryCell& midway, double cell_size, const PlannedDig& below,
                             const PlannedDig& above, double best);

/// What is looked up midway between the slope of an entry and the next, at its density.
struct SlopeGap {
  std::size_t entry = 0;  ///< in the library
  double density_percent = 0.0;
  double middle = 0.0;  ///< slope [rad]
  PlannedDig looked_up;
  double best_expected = 0.0;  ///< efficiency there [kg/J]
};

/// Of all entries but those of the last slope, and those whose density has no dig on the next.
std::vector<SlopeGap> slope_gaps(const PathLibrary& library);

}  // namespace excavplan
