// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/density_law.hpp>

/// @file
/// The densities that successive digs give for one ground (docs/methods.md#second-densities).

namespace excavplan {

/// Standard deviation of the density from one dig to the next [points]; ours. Where the density of
/// a site scatters by 7.5 points and its places forget each other over 30 m, places 3 m apart
/// differ by 4.5.
inline constexpr double usual_drift_percent = 5.0;

/// The density that earlier digs gave, with its error in parts.
struct PriorDensity {
  double raw_percent = 0.0;  ///< also outside 0 .. 100
  /// Of what each dig measures anew.
  double independent_sd_percent = 0.0;
  /// Of the law: how the soil of the site differs from its kind, the same in all its digs.
  double shared_sd_percent = 0.0;
  double drift_sd_percent = usual_drift_percent;  ///< of the ground from that dig to this one
  bool trustworthy = true;                        ///< false: it is not used
};

/// @param drift_sd_percent  at least 0
PriorDensity prior_of(const RelativeDensity& density,
                      double drift_sd_percent = usual_drift_percent);

/// The density of this dig and of those before it.
struct SuccessiveDensity {
  PriorDensity prior;              ///< that was combined
  RelativeDensity this_dig;        ///< without it
  RelativeDensity density;         ///< of both; that of this dig where they disagree
  double shared_sd_percent = 0.0;  ///< part of its sd by the law
  double weight = 0.0;             ///< of the prior in it, 0 .. 1
  double disagreement = 0.0;       ///< this dig less the prior, in standard deviations
  bool disagrees() const;          ///< by more than 2.5 of them
};

/// The mean of least variance, whose independent error falls from dig to dig while the shared one
/// stays. Where both disagree, the ground or one of the surveys is another: the result is that of
/// this dig alone and not trustworthy.
///
/// @throws Error (bad_input) unless all numbers are finite and the deviations at least 0
SuccessiveDensity combined(const PriorDensity& prior, const RelativeDensity& this_dig);

}  // namespace excavplan
