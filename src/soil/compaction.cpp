// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/compaction.hpp>

#include <algorithm>

#include "base/check.hpp"

namespace excavplan {

Compaction compaction_of(const SoilKind& soil, const RelativeDensity& density,
                         double proctor_density) {
  require_in("Proctor density [kg/m3]", proctor_density, 500.0, 3500.0);
  const auto at = [&](double percent) {
    return 100.0 * bank_state(soil, std::clamp(percent, 0.0, 100.0)).dry_density / proctor_density;
  };
  constexpr double step = 0.5;  // of a difference quotient [points]
  const double low = std::max(0.0, density.percent - step);
  const double high = std::min(100.0, density.percent + step);
  return {at(density.percent),
          density.sd_percent * (at(high) - at(low)) / (high - low),
          {at(density.interval_percent[0]), at(density.interval_percent[1])}};
}

}  // namespace excavplan
