// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/trial/hidden_site.hpp>

namespace excavplan {

/// The design on the cells of the true ground.
struct ScoredDesign {
  HeightMap height;        ///< of the design inside its footprint, NaN outside of it
  Eigen::ArrayXXd share;   ///< of each cell in the footprint [-]
  Eigen::ArrayXXd gentle;  ///< likewise, 0 on faces steeper than CutOptions::steepest

  /// Volume from the design up to a surface, where that is higher [m^3].
  double below(const Eigen::ArrayXXd& surface) const;
};

/// The footprint: where the design lies below the ground before.
ScoredDesign scored_design(const SiteBrief& site, const HeightMap& before);

}  // namespace excavplan
