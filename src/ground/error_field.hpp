// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/registration.hpp>

#include "ground/noise_model.hpp"

/// @file
/// The error of height differences: estimated on stable ground, predicted for the zones. Private to
/// the project.

namespace excavplan {

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

}  // namespace excavplan
