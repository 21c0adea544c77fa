// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/ground/volume_change.hpp>

namespace excavplan {

/// Bulking factor k = V_after / V_before (the paper's eq. 1) and its standard deviation by the
/// delta method, covariance included: u_k^2 = u_a^2 + u_b^2 - 2 cov / (V_a V_b).
///
/// @return nothing if no hole was found, no dumped soil is in the scans or too much of a zone was
///         unseen, which a warning in `change` says
std::optional<Measured> bulking_factor(const VolumeChange& change);

/// Standard deviation of the bulking factor by source [-].
struct BulkingErrors {
  double noise = 0.0;
  double correlated = 0.0;
  double datum = 0.0;
  double holes = 0.0;
  double faces = 0.0;
};

/// Splits the standard deviation of bulking_factor(); all zero where that is nothing.
BulkingErrors bulking_errors(const VolumeChange& change);

/// Frees a bulking factor measured from height maps of the soil that fell back into the cut.
///
/// k = f + (1 - f) k_measured, f = loose soil lying in the pit / volume of the cut
/// (docs/methods.md#density-law).
///
/// @throws Error (bad_input) unless 0 <= f < 1
double free_of_fallback(double bulking_measured, double fallback_fraction);

}  // namespace excavplan
