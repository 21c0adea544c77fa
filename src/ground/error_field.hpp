// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/registration.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// The error of height differences: estimated on stable ground, predicted for the zones. Private to
/// the project.

namespace excavplan {

constexpr double least_noise = 1e-4;  ///< ours: no survey of soil is better [m]

/// Covariance of the error of height differences: white from cell to cell, and a part that
/// neighbours share, correlated exp(-(distance / length)^power).
struct NoiseModel {
  double white = 0.0;       ///< [m^2]
  double correlated = 0.0;  ///< [m^2]
  double length = 0.0;      ///< [m]
  double power = 1.0;       ///< in (0, 2], for which the covariance is valid

  double at(double distance) const;
  /// Integral of the correlated part over the plane [m^4].
  double integral() const;
  /// Variance of independent cells that gives the mean over a large area the same error [m^2].
  double large_area_variance(double cell_size) const {
    return white + integral() / (cell_size * cell_size);
  }
};

/// The noise of residuals (NaN where the ground is not stable), from their empirical covariance
/// along rows and columns. White if no lag is significant (Bartlett 1946), else fitted up to twice
/// the first lag that is not.
NoiseModel find_noise(const Eigen::ArrayXXd& residual, double cell_size);

/// How a motion changes the height of a cell at `place` from the centre of rotation, by the
/// gradient of the ground there.
inline Motion motion_effect(const Eigen::Vector3d& place, const Eigen::Vector2d& gradient) {
  Motion effect;
  effect << -gradient.x(), -gradient.y(), 1.0, place.y() + gradient.y() * place.z(),
      -place.x() - gradient.x() * place.z(), gradient.x() * place.y() - gradient.y() * place.x();
  return effect;
}

/// Gradient of a map by planes through 3 x 3 cells; NaN where a cell of them is unknown.
struct Gradient {
  Eigen::ArrayXXd x;
  Eigen::ArrayXXd y;
};
Gradient gradient_of(const HeightMap& map);

/// Errors of the volumes of zones, predicted by the ground around them [m^3, m^6].
struct ZoneErrors {
  Eigen::VectorXd mean;  ///< expected error of each volume
  Eigen::MatrixXd correlated;
  Eigen::MatrixXd datum;
};

/// The error of height differences on one area, known on stable ground and predicted in the zones:
/// kriging with the motion that may be left as trend (Matheron 1969).
struct ErrorField {
  const HeightMap& before;
  const Eigen::ArrayXXd& residual;  ///< of stable cells, else NaN
  const Eigen::ArrayXXi& zone;      ///< -1 for stable ground
  int zones = 0;
  NoiseModel noise;
  const Alignment& alignment;

  ZoneErrors predict() const;
};

/// The highest surface below `z` whose slope is nowhere above `rise` per cell. Unknown cells are no
/// bound.
Eigen::ArrayXXd slope_limited(const Eigen::ArrayXXd& z, double rise);

/// From every cell to the nearest one that is marked, within 8 % (chamfer); infinite without one
/// [cell].
Eigen::ArrayXXd distance_to(const Mask& marked);

}  // namespace excavplan
