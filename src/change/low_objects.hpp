// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// The top of what lies on dug ground and is no soil, or may be none.
struct LevelTop {
  std::vector<Cell> cells;  ///< of the top
  bool is_sure = true;      ///< false: it might be soil that was left standing
};

/// The tops of things that lie on dug ground in the scan after, as a crate does: level to 6
/// degrees, 0.03 to 1 m^2, with sides that fall on three sides at least by 0.1 m and more steeply
/// than 50 degrees, which loose soil does not, where the ground around has changed (all ours). More
/// than two of them are blocks of soil, and none is given.
///
/// Not sure are those that fall along less than 45 % of their edge, but 30 % at least, as beside
/// the wall of the hole; and those as high as the ground was, unless they stood out of it before,
/// as walls do.
/// @param on_any_ground  whether the ground around changed or not, and none that is as high
///        in the other scan
std::vector<LevelTop> level_tops(const Eigen::ArrayXXd& before, const Eigen::ArrayXXd& after,
                                 double cell_size, bool on_any_ground = false);

}  // namespace excavplan
