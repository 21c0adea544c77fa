// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// Something that stands in one of two scans and is no soil: a person, a truck, the bucket.
struct Object {
  std::vector<Cell> cells;  ///< where it stands, with a margin
  bool is_blunder = false;  ///< no more than a few cells that outliers spoilt
  bool is_before = false;   ///< in the scan before, else after
  double volume = 0.0;      ///< of the change it makes, < 0 if it went [m^3]
};

/// Finds objects and takes them out of their scan: their cells become unknown.
///
/// An object stands higher above its surroundings than soil can: more than 0.5 m above the surface
/// of slope 60 degrees laid against them, in its own scan and in the change, on ground that rose
/// by less than a fifth of that itself. Freshly dug soil stands at 28 to 45 degrees, and in heaps
/// of blocks as rough as those are large.
///
/// @param margin by which what is found is widened, 1.5 at least (ours); 0: not at all [cell]
std::vector<Object> take_out_objects(Eigen::ArrayXXd& before, Eigen::ArrayXXd& after,
                                     double cell_size, double margin);

}  // namespace excavplan
