// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/density_result.hpp>

namespace excavplan {

std::optional<GroundDensity> DensityEstimate::ground_density() const {
  if (!density) return std::nullopt;
  GroundDensity ground(density->percent, density->sd_percent);
  ground.trustworthy = trustworthy;
  ground.soil = law.soil;
  return ground;
}

}  // namespace excavplan
