// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

/// @file
/// Mixtures of normal distributions. Private to the project.

namespace excavplan {

constexpr double two_sided_95_percent = 1.96;  ///< standard deviations

inline double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// One normal distribution of a mixture.
struct NormalPart {
  double weight = 0.0;  ///< those of a mixture need not add up to 1
  double mean = 0.0;
  double sd = 0.0;  ///< > 0
};

/// The value below which this share of a mixture lies, by bisection.
/// @param parts  at least one
/// @param share  in (0, 1)
inline double quantile_of(const std::vector<NormalPart>& parts, double share) {
  constexpr double reach = 10.0;  // sd: beyond it there is nothing
  double low = parts.front().mean;
  double high = low;
  double sum = 0.0;
  for (const NormalPart& part : parts) {
    low = std::min(low, part.mean - reach * part.sd);
    high = std::max(high, part.mean + reach * part.sd);
    sum += part.weight;
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const NormalPart& part : parts) {
      below += part.weight * normal_cdf((middle - part.mean) / part.sd);
    }
    (below < share * sum ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace excavplan
