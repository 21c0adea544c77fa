// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/trial/hidden_site.hpp>

namespace excavplan {

/// The design on the cells of the true ground.
struct ScoredDesign {
  HeightMap height;  ///< of the design inside its footprint, NaN outside of it
  HeightMap gentle;  ///< the same without faces steeper than CutOptions::steepest
};

/// The footprint: cells that the design covers whole and where it lies below the ground before.
ScoredDesign scored_design(const SiteBrief& site, const HeightMap& before);

}  // namespace excavplan
