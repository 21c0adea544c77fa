// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <excavplan/base/measured.hpp>
#include <excavplan/change/dig_volumes.hpp>

namespace excavplan {

/// Bulking factor k = V_after / V_before (the paper's eq. 1) and its standard deviation by the
/// delta method, covariance included: u_k^2 = u_a^2 + u_b^2 - 2 cov / (V_a V_b).
///
/// @param change volumes of a dig; its warnings give the reason for a missing bulking factor
/// @return nothing if no hole was found, no dumped soil is in the scans, or too much of a zone was
///         not seen
std::optional<Measured> bulking_factor(const VolumeChange& change);

/// Interval of 95 % of the bulking factor, which holds each reading of more than 5 %: quantiles of
/// the mixture of the readings, each with the error that they do not explain. k -+ 1.96 sd where
/// the scene has one reading. Readings that no scan shows (is_unseen()) are left out.
///
/// @return nothing where there is no factor or its error is not known
std::optional<std::array<double, 2>> bulking_interval(const VolumeChange& change);

/// Variance of the bulking factor that its readings explain [-]: at most that of attribution.
double variance_by_readings(const VolumeChange& change);

/// Standard deviation of the bulking factor by source [-].
struct BulkingErrors {
  double noise = 0.0;        ///< as in VolumeErrors
  double correlated = 0.0;   ///< likewise
  double datum = 0.0;        ///< likewise
  double holes = 0.0;        ///< likewise
  double faces = 0.0;        ///< likewise
  double thin = 0.0;         ///< likewise
  double attribution = 0.0;  ///< likewise
  double scans = 0.0;        ///< all but attribution
};

/// The standard deviation of bulking_factor() by source; all zero where there is no factor.
BulkingErrors bulking_errors(const VolumeChange& change);

/// Corrects a bulking factor from height maps for the soil that fell back into the cut:
/// k = f + (1 - f) k_measured (`docs/methods.md#density-law`).
///
/// @param bulking_measured k_measured, > 0 [-]
/// @param fallback_fraction f = volume of loose soil in the pit / volume of the cut [-]
/// @throws Error (bad_input) unless 0 <= f < 1
double free_of_fallback(double bulking_measured, double fallback_fraction);

}  // namespace excavplan
