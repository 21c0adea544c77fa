// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "belief/belief_settings.hpp"

#include "base/check.hpp"

namespace excavplan {

void require_settings(const BeliefSettings& settings) {
  require_in("belief: mean density [%]", settings.mean_percent, -100.0, 200.0);
  for (const double sd :
       {settings.level_sd_percent, settings.trend_sd_percent_per_m, settings.spread_percent,
        settings.law_sd_percent, settings.payload_sd_percent}) {
    require_in("belief: a standard deviation of density [points]", sd, 0.0, 1000.0);
  }
  require_in("belief: correlation length [m]", settings.length, 0.01, 1e4);
  require_in("belief: correlation length over depth [m]", settings.depth_length, 0.01, 1e4);
  require_in("belief: sd of ln(factor on the strength)", settings.log_strength_sd, 0.0, 5.0);
}

}  // namespace excavplan
