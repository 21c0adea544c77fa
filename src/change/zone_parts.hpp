// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "change/change_zones.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {

/// What became of a zone, or of a part of one.
enum class Part {
  whole,  ///< a zone, or what is left of it without its tails
  tail,   ///< low ground that a deep or high zone runs out into, farther than its own edge reaches
  churn,  ///< ground that was stirred: it rose and fell in many small places
};

/// The parts of the zones of an area, and how much stirred ground differs from cell to cell.
struct ZoneParts {
  std::vector<Part> part;   ///< of each zone
  std::vector<int> parent;  ///< the zone that a tail was cut from; -1 otherwise
  /// Variance per area of the signed volume of zones that lie in stirred ground [m^4]; 0 elsewhere.
  std::vector<double> stirred;
};

/// Cuts the tails off deep and high zones, as zones of their own, and finds stirred ground. A
/// counted zone in stirred ground takes in all of it that is near, whether it rose or fell, so that
/// its signed sum has no bias.
ZoneParts part_zones(ChangedGround& ground, double cell_size);

/// The cells of each zone.
std::vector<std::vector<Cell>> cells_of(const ChangedGround& ground);

}  // namespace excavplan
