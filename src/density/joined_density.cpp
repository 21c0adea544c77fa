// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "density/joined_density.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan {

JoinedDensity joined(const TwoDensities& both) {
  const Eigen::Matrix2d& c = both.covariance;
  const double variance = c(0, 0) + c(1, 1) - 2.0 * c(0, 1);  // of the difference
  JoinedDensity result;
  result.difference_sd = std::sqrt(variance);
  if (variance > 0.0) {
    result.disagreement = (both.percent(1) - both.percent(0)) / result.difference_sd;
    result.second_share = std::clamp((c(0, 0) - c(0, 1)) / variance, 0.0, 1.0);
  }
  const Eigen::Vector2d share(1.0 - result.second_share, result.second_share);
  result.percent = share.dot(both.percent);
  result.sd = std::sqrt(share.dot(c * share));
  result.measurement_sd = std::sqrt(share.dot(both.by_measurement * share));
  return result;
}

double shared_sd_of(const RelativeDensity& density) {
  const double excess = density.raw_percent - density.percent;
  return std::sqrt(std::max(0.0, std::pow(density.sd_percent, 2) - excess * excess -
                                     std::pow(density.sd_given_law_percent, 2)));
}

RelativeDensity answer_of(const JoinedDensity& joined, const RelativeDensity& first, double sd) {
  RelativeDensity answer = first;
  answer.raw_percent = joined.percent;
  answer.percent = std::clamp(joined.percent, 0.0, 100.0);
  answer.sd_given_law_percent = joined.measurement_sd;
  set_error(answer, sd);
  answer.trustworthy = answer.trustworthy && first.trustworthy;
  return answer;
}

}  // namespace excavplan
