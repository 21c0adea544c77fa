// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace excavplan {

/// The highest of each cell and those up to so many cells away along both axes; NaN is not allowed.
Eigen::ArrayXXd highest_within(const Eigen::ArrayXXd& z, Eigen::Index cells);

/// Likewise the lowest.
inline Eigen::ArrayXXd lowest_within(const Eigen::ArrayXXd& z, Eigen::Index cells) {
  return -highest_within(-z, cells);
}

/// `value` in place of NaN.
inline Eigen::ArrayXXd without_nan(const Eigen::ArrayXXd& z, double value) {
  return z.isNaN().select(value, z);
}

}  // namespace excavplan
