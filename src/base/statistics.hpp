// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

/// @file
/// Order statistics, robust means and deviations, and normal distributions. Private to the project.

namespace excavplan {

// ---- Order: reorders the values, at least one ---------------------------------------------------

/// The upper of the two in the middle where the count is even.
double median(std::vector<double>& values);
std::int64_t median(std::vector<std::int64_t>& values);

/// The mean of the two in the middle where the count is even.
double mean_median(std::vector<double>& values);
double mean_median(std::vector<float>& values);

/// The one that this share of them, rounded down, lie below; the highest for all. The median for a
/// half.
double upper_quantile(std::vector<double>& values, double share);

/// The one at a share of the way from the lowest to the highest in order, rounded down; 0 of none.
double quantile(std::vector<double> values, double share);

// ---- Robust -------------------------------------------------------------------------------------

constexpr double mad_to_sd = 1.4826;  ///< of a normal distribution, from its median deviation

/// Standard deviation by the median of distances from the middle, at least one; reorders them.
double robust_sd(std::vector<double>& distances);

/// Middle and standard deviation of a distribution.
struct Spread {
  double middle = 0.0;
  double sd = 0.0;
};

/// By medians; of at least one value.
Spread robust_spread(std::vector<double> values);

struct RobustMean {
  double value = 0.0;
  double variance = 0.0;  ///< of one of the values that count; 0 of a single one
  int count = 0;          ///< values that agree, 0 without values
};

/// What several measurements of one thing agree on: the mean of the values within 3 robust sd
/// (1.4826 MAD), or within `least` if that is more, of their median.
RobustMean robust_mean(const std::vector<double>& values, double least);

// ---- Normal distributions -----------------------------------------------------------------------

constexpr double two_sided_95_percent = 1.96;  ///< standard deviations

double normal_cdf(double z);

/// One normal distribution of a mixture.
struct NormalPart {
  double weight = 0.0;  ///< those of a mixture need not add up to 1
  double mean = 0.0;
  double sd = 0.0;  ///< > 0
};

/// The value below which this share of a mixture lies, by bisection.
/// @param parts  at least one
/// @param share  in (0, 1)
double quantile_of(const std::vector<NormalPart>& parts, double share);

}  // namespace excavplan
