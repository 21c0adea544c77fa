// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/density/successive_density.hpp>

#include <cmath>

#include "base/check.hpp"
#include "density/joined_density.hpp"

namespace excavplan {

PriorDensity prior_of(const RelativeDensity& density, double drift_sd_percent) {
  return {density.raw_percent, density.sd_given_law_percent, shared_sd_of(density),
          drift_sd_percent, density.trustworthy};
}

bool SuccessiveDensity::disagrees() const { return std::abs(disagreement) > largest_disagreement; }

SuccessiveDensity combined(const PriorDensity& prior, const RelativeDensity& this_dig) {
  require(std::isfinite(prior.raw_percent), "prior density [%]", prior.raw_percent, "finite");
  for (const double sd :
       {prior.independent_sd_percent, prior.shared_sd_percent, prior.drift_sd_percent}) {
    require(sd >= 0.0 && std::isfinite(sd), "prior density: a standard deviation", sd,
            "at least 0 and finite");
  }
  SuccessiveDensity result;
  result.prior = prior;
  result.this_dig = result.density = this_dig;
  const Eigen::Vector2d shared(shared_sd_of(this_dig), prior.shared_sd_percent);
  TwoDensities both{{this_dig.raw_percent, prior.raw_percent}, Eigen::Matrix2d::Zero()};
  both.by_measurement = Eigen::Vector2d(std::pow(this_dig.sd_given_law_percent, 2),
                                        std::pow(prior.independent_sd_percent, 2) +
                                            std::pow(prior.drift_sd_percent, 2))
                            .asDiagonal();
  both.covariance = both.by_measurement + shared * shared.transpose();
  const JoinedDensity mean = joined(both);
  result.disagreement = -mean.disagreement;
  if (result.disagrees()) {
    result.density.trustworthy = false;
  } else {
    result.weight = mean.second_share;
    result.density = answer_of(mean, this_dig, mean.sd);
  }
  result.shared_sd_percent = shared_sd_of(result.density);
  return result;
}

}  // namespace excavplan
