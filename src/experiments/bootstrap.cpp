// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <excavplan/experiments/study_result.hpp>

#include "base/random.hpp"

namespace excavplan {

StudyMean bootstrap_mean(const std::vector<double>& values, std::uint64_t seed) {
  constexpr int samples = 2000;
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {none, {none, none}, 0};
  const auto count = static_cast<double>(values.size());
  std::vector<double> means;
  means.reserve(samples);
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    Random random(seed, sample);
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[random.index(values.size())];
    means.push_back(sum / count);
  }
  std::sort(means.begin(), means.end());
  const auto quantile = [&](double share) {
    return means[static_cast<std::size_t>(std::lround(share * (samples - 1)))];
  };
  return {std::accumulate(values.begin(), values.end(), 0.0) / count,
          {quantile(0.025), quantile(0.975)},
          static_cast<int>(values.size())};
}

}  // namespace excavplan
