// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/bulking.hpp>

#include <algorithm>
#include <cmath>

#include "json_file.hpp"

namespace excavplan {

std::optional<Measured> bulking_factor(const VolumeChange& change) {
  const bool soil_is_missing =
      std::any_of(change.warnings.begin(), change.warnings.end(),
                  [](const Warning& warning) { return warning.code == "no_dumped_soil"; });
  if (soil_is_missing || !(change.before.value > 0.0) || !(change.after.value > 0.0)) {
    return std::nullopt;
  }
  const double before = change.before.value;
  const double after = change.after.value;
  const double relative_before = change.before.sd / before;
  const double relative_after = change.after.sd / after;
  const double relative_variance = relative_after * relative_after +
                                   relative_before * relative_before -
                                   2.0 * change.covariance_before_after / (before * after);
  const double factor = after / before;
  // This order keeps an unknown (NaN) variance unknown.
  return Measured{factor, factor * std::sqrt(std::max(relative_variance, 0.0))};
}

double free_of_fallback(double bulking_measured, double fallback_fraction) {
  if (!(fallback_fraction >= 0.0 && fallback_fraction < 1.0)) {
    throw Error(ErrorKind::bad_input,
                "fallback fraction is " + number_text(fallback_fraction) + ", must be in [0, 1)");
  }
  return fallback_fraction + (1.0 - fallback_fraction) * bulking_measured;
}

}  // namespace excavplan
