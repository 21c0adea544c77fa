// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace excavplan {
namespace {

/// The value that `rank` others come before in order.
template <typename T>
T at_rank(std::vector<T>& values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

template <typename T>
T upper_median(std::vector<T>& values) {
  return at_rank(values, values.size() / 2);
}

template <typename T>
double mean_of_medians(std::vector<T>& values) {
  const auto upper = static_cast<double>(upper_median(values));
  if (values.size() % 2 == 1) return upper;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return 0.5 * (upper + static_cast<double>(*std::max_element(values.begin(), middle)));
}

}  // namespace

double median(std::vector<double>& values) { return upper_median(values); }
std::int64_t median(std::vector<std::int64_t>& values) { return upper_median(values); }

double mean_median(std::vector<double>& values) { return mean_of_medians(values); }
double mean_median(std::vector<float>& values) { return mean_of_medians(values); }

double upper_quantile(std::vector<double>& values, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return at_rank(values, std::min(rank, values.size() - 1));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  return at_rank(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

double robust_sd(std::vector<double>& distances) { return mad_to_sd * median(distances); }

Spread robust_spread(std::vector<double> values) {
  Spread spread;
  spread.middle = median(values);
  for (double& value : values) value = std::abs(value - spread.middle);
  spread.sd = robust_sd(values);
  return spread;
}

RobustMean robust_mean(const std::vector<double>& values, double least) {
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

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double quantile_of(const std::vector<NormalPart>& parts, double share) {
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
