// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/belief/believed_density.hpp>

#include "base/statistics.hpp"

namespace excavplan {

Eigen::ArrayXd BelievedDensity::percent() const { return raw_percent.max(0.0).min(100.0); }

std::array<Eigen::ArrayXd, 2> BelievedDensity::interval_percent() const {
  const Eigen::ArrayXd half = two_sided_95_percent * sd_percent;
  return {(raw_percent - half).max(0.0).min(100.0), (raw_percent + half).max(0.0).min(100.0)};
}

}  // namespace excavplan
