// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/base/measured.hpp>

/// @file
/// What is known of the ground before a dig beside its surface, for measure_change(): its loose
/// soil and what the bucket cut (docs/methods.md#known-ground).

namespace excavplan {

/// Ground of which the loose soil is known. Layers are on the grid of the surfaces, or empty.
struct KnownGround {
  Eigen::ArrayXXd loose;     ///< thickness of the loose soil [m], >= 0; NaN counts as none
  Eigen::ArrayXXd loose_sd;  ///< of it, independent from cell to cell [m]; NaN counts as 0
  /// Of the surface before where no survey showed it and neighbours err alike [m]; 0 or NaN: seen.
  Eigen::ArrayXXd guessed_sd;
  double common_sd = 0.005;  ///< of it in all cells alike [m]; ours: two registrations
  /// What loose soil gains when it is dug again, as a share of its volume: it was compacted since
  /// it was dug. Empty: nothing.
  Eigen::ArrayXXd swelling;
  Eigen::ArrayXXd cut;    ///< bank that the bucket cut [m], >= 0; empty: its path is not told
  Eigen::ArrayXXd cover;  ///< share of each cell that it swept, as large as `cut`
};

/// What was cut, by the surfaces and the known ground [m^3].
struct KnownCut {
  Measured loose;            ///< loose soil that was dug again
  Measured bank;             ///< undisturbed soil that was cut, with what is hidden by `fallen`
  double fallen = 0.0;       ///< loose soil above the floor that was swept; 0 where it is not told
  double swept_area = 0.0;   ///< of it where bank was cut [m^2]
  double unseen_area = 0.0;  ///< and of that what one of the surfaces does not show [m^2]

  /// Share of bank in what was cut, by volume [-].
  double bank_share() const {
    if (!(bank.value > 0.0)) return 0.0;
    return loose.value > 0.0 ? bank.value / (bank.value + loose.value) : 1.0;
  }
};

}  // namespace excavplan
