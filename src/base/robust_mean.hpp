// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file What several measurements of one thing agree on. Private to the library.

namespace excavplan {

/// The mean of the two in the middle where the count is even. Reorders the values, at least one.
inline double mean_median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

struct RobustMean {
  double value = 0.0;
  double variance = 0.0;  ///< of one of the values that count; 0 of a single one
  int count = 0;          ///< values that agree, 0 without values
};

/// The mean of the values within 3 robust sd (1.4826 MAD), or within `least` if that is more, of
/// their median.
inline RobustMean robust_mean(const std::vector<double>& values, double least) {
  constexpr double mad_to_sd = 1.4826;
  constexpr double within = 3.0;
  RobustMean mean;
  if (values.empty()) return mean;
  std::vector<double> work = values;
  const double middle = mean_median(work);
  for (double& value : work) value = std::abs(value - middle);
  const double limit = std::max(least, within * mad_to_sd * mean_median(work));
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    if (std::abs(value - middle) > limit) continue;
    sum += value - middle;
    squares += (value - middle) * (value - middle);
    ++mean.count;
  }
  if (mean.count == 0) return mean;
  mean.value = middle + sum / mean.count;
  if (mean.count > 1) {
    mean.variance = std::max(0.0, squares - sum * sum / mean.count) / (mean.count - 1);
  }
  return mean;
}

}  // namespace excavplan
