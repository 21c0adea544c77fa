// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace excavplan {

/// A connected piece of unknown cells with known cells all around it.
struct Hole {
  Eigen::Index cells = 0;
  /// Mean square of the height steps between neighbouring known cells of its rim [m^2].
  double squared_rim_step = 0.0;
};

struct FilledHoles {
  Eigen::ArrayXXi hole;  ///< index into `holes`, -1 for known cells and for what stays unknown
  std::vector<Hole> holes;
};

/// Fills the holes of a height field by a membrane through their rims (Laplace's equation).
/// Unknown cells that connect to the border of the field lie outside the survey and stay NaN.
FilledHoles fill_holes(Eigen::ArrayXXd& z);

}  // namespace excavplan
