// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// The connected pieces of unknown cells with known cells all around them.
struct Holes {
  Eigen::ArrayXXi index;  ///< into `cells`, -1 for known cells and for what lies outside the survey
  std::vector<std::vector<Cell>> cells;
};

/// Unknown cells that connect to the border of the field lie outside the survey and are no holes.
Holes find_holes(const Eigen::ArrayXXd& z);

/// Energy that the filled surface makes least.
enum class Filling {
  membrane,    ///< squared slope: no overshoot
  thin_plate,  ///< squared curvature and a little squared slope: carries slopes on
};

/// Fills the given cells of a height field, smoothly from their known neighbours.
void fill(Eigen::ArrayXXd& z, const std::vector<Cell>& unknown, Filling filling);

/// Fills all holes by a membrane (Laplace's equation).
Holes fill_holes(Eigen::ArrayXXd& z);

/// Tries a hole's filling at places that are known: the hole's shape is moved there, turned and
/// mirrored, filled by a thin plate and compared. An error counts by the relief of the rim where
/// it was tried against that of the hole itself, for a hole on a wall errs more than one on level
/// ground; it is at least the difference between thin plate and membrane.
///
/// @param z heights, NaN in the hole and wherever nothing is known
/// @param hole all cells of the hole
/// @param summed those of them whose sum matters, in the same order
/// @param tried where the shape may be tried
/// @return variance of the sum of the filled heights [m^2]
double error_of_filling(const Eigen::ArrayXXd& z, const std::vector<Cell>& hole,
                        const std::vector<Cell>& summed, const std::vector<Cell>& tried);

}  // namespace excavplan
