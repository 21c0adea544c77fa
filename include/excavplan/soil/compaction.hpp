// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Dry density in place over the largest of a Proctor test.
struct Compaction {
  double percent = 0.0;                                 ///< [%]
  double sd_percent = 0.0;                              ///< by that of the density [points]
  std::array<double, 2> interval_percent = {0.0, 0.0};  ///< of 95 % [%]
};

/// Of a relative density, by the void ratios of its soil.
/// @param proctor_density  the largest dry density of a Proctor test of this soil [kg/m^3]
/// @throws Error (bad_input) unless that is 500 .. 3500 kg/m^3 (ours), or as bank_state()
Compaction compaction_of(const SoilKind& soil, const RelativeDensity& density,
                         double proctor_density);

}  // namespace excavplan
