// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/loose_soil.hpp>

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "soil/loose_soil.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

// The compression index of inorganic soils from their loosest void ratio: Hough 1957 (recalled).
constexpr double compression_slope = 0.30;
constexpr double compression_origin = 0.27;
/// Up to here dug soil keeps the state that it fell in: the pressure under some 0.4 m of it; ours
/// [Pa].
constexpr double first_compressing = 5000.0;

void require_loose(const SoilKind& soil, double void_ratio) {
  require_soil(soil);
  require_in("void ratio of loose " + soil.name, void_ratio, soil.void_ratio_min,
             soil.void_ratio_loose);
}

}  // namespace

double checked_compaction(const SoilKind& soil, double void_ratio, double pressure) {
  const double index =
      std::max(0.0, compression_slope * (soil.void_ratio_loose - compression_origin));
  const double ratio = std::max(1.0, pressure / first_compressing);
  const double pressed = soil.void_ratio_loose - index * std::log10(ratio);
  return std::min(void_ratio, std::max(pressed, soil.void_ratio_min));
}

SoilState loose_state_of_void_ratio(const SoilKind& soil, double void_ratio) {
  require_loose(soil, void_ratio);
  return checked_loose_state(soil, void_ratio);
}

double compacted_void_ratio(const SoilKind& soil, double void_ratio, double pressure) {
  require_loose(soil, void_ratio);
  require(pressure >= 0.0 && std::isfinite(pressure), "pressure on loose soil [Pa]", pressure,
          "not negative and finite");
  return checked_compaction(soil, void_ratio, pressure);
}

}  // namespace excavplan
