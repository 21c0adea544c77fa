// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/soil/density_law.hpp>

/// @file
/// Two densities of one ground joined by their errors (docs/methods.md#second-densities).

namespace excavplan {

/// Two densities of the same ground and their covariance.
struct TwoDensities {
  Eigen::Vector2d percent;
  Eigen::Matrix2d covariance;  ///< [points^2]
  /// The part of it that another dig would draw anew.
  Eigen::Matrix2d by_measurement = Eigen::Matrix2d::Zero();
};

/// Their mean of least variance: for normal errors, the maximum of the product of both.
struct JoinedDensity {
  double percent = 0.0;         ///< also outside 0 .. 100
  double sd = 0.0;              ///< [points]
  double measurement_sd = 0.0;  ///< the part of it by TwoDensities::by_measurement
  double second_share = 0.0;    ///< weight of the second, in 0 .. 1
  double difference_sd = 0.0;   ///< of the second less the first [points]
  double disagreement = 0.0;    ///< that difference over its standard deviation
};
JoinedDensity joined(const TwoDensities& both);

/// Densities that lie further apart, in standard deviations, are not of the same ground; ours.
inline constexpr double largest_disagreement = 2.5;

/// The error of a density that is not of the measurement, and not its excess over 0 .. 100 %: that
/// of the law, the same in every dig of one soil [points].
double shared_sd_of(const RelativeDensity& density);

/// The answer of a joined density that was `first` before. What was not trusted stays so.
/// @param sd  of it [points]
RelativeDensity answer_of(const JoinedDensity& joined, const RelativeDensity& first, double sd);

}  // namespace excavplan
