// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// An object in one of two scans that is no soil: a person, a truck, the bucket.
struct Object {
  std::vector<Cell> cells;  ///< that it covers, with a margin
  bool is_blunder = false;  ///< only a few cells with outliers
  bool is_before = false;   ///< in the scan before, else after
  bool is_low = false;      ///< lies on dug ground, as a crate does: level_tops()
  bool is_sure = true;      ///< false: it may be soil
  double volume = 0.0;      ///< of the change it causes, < 0 if it was removed [m^3]
};

/// Finds objects and removes them from their scan: their cells become unknown.
///
/// An object is higher above its surroundings than soil can be: by more than 0.5 m above a surface
/// of slope 60 degrees through them, in its own scan and in the change, where the ground itself
/// rose by less than a fifth of that; or it has a level top and steep sides on dug ground. Freshly
/// dug soil stands at 28 to 45 degrees; heaps of blocks are as rough as the blocks are large.
///
/// In known ground (`dug` is given) nothing is removed from the scan before: its things are known.
/// Cells on the face of a wall that stands in both scans become unknown in both: their height is
/// that of a mixture of wall, face and ground, which soil against the wall changes. Not so where
/// `dug` is 1: walls of earlier digs in known ground.
///
/// @param margin by which objects are widened, at least 1.5 (ours); 0: not at all [cell]
std::vector<Object> take_out_objects(Eigen::ArrayXXd& before, Eigen::ArrayXXd& after,
                                     double cell_size, double margin,
                                     const Eigen::ArrayXXi& dug = {});

/// True if two opposite neighbours of the cell differ by more than 0.5 m (ours).
bool is_beside_wall(const Eigen::ArrayXXd& z, Cell at);

}  // namespace excavplan
