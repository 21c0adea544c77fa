// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include <excavplan/base/measured.hpp>

/// @file
/// What a belief answers.

namespace excavplan {

/// Believed densities of places. They are unbounded; what is read as a density is clipped.
struct BelievedDensity {
  Eigen::ArrayXd raw_percent;  ///< means
  Eigen::ArrayXd sd_percent;   ///< [points]

  Eigen::ArrayXd percent() const;                          ///< means inside 0 .. 100
  std::array<Eigen::ArrayXd, 2> interval_percent() const;  ///< 95 %, inside 0 .. 100
};

/// Believed mean densities of parts of the ground.
struct BelievedMeans {
  Eigen::VectorXd raw_percent;  ///< means
  Eigen::MatrixXd covariance;   ///< [points^2]
};

/// What all digs have in common.
struct CommonStates {
  Measured law_error_percent;      ///< of the density law [points]
  Measured payload_error_percent;  ///< of the payload's scale [points]
  Measured log_strength;           ///< ln(factor on the soil's strength)
};

}  // namespace excavplan
