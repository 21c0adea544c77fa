// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// @file
/// How much height differences of two scans err, from ground that did not change. Private to the
/// project.

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

}  // namespace excavplan
