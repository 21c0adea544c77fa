// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// The tops of things that lie on dug ground in the scan after, as a crate does: level to 6
/// degrees, 0.03 to 1 m^2, with sides that fall on three sides at least by 0.1 m and more steeply
/// than 50 degrees, which loose soil does not, where the ground around has changed (all ours). More
/// than two of them are blocks of soil, and none is given.
std::vector<std::vector<Cell>> level_tops(const Eigen::ArrayXXd& before,
                                          const Eigen::ArrayXXd& after, double cell_size);

}  // namespace excavplan
