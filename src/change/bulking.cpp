// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/bulking.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.hpp"
#include "base/statistics.hpp"

namespace excavplan {

namespace {

/// The 95 % interval of a mixture; one that reaches into a part takes all of its interval, for the
/// weight of a reading is not known so well that it could be cut in two.
std::array<double, 2> interval_of(const std::vector<NormalPart>& parts) {
  const double low = quantile_of(parts, 0.025);
  const double high = quantile_of(parts, 0.975);
  std::array<double, 2> interval = {low, high};
  for (const NormalPart& part : parts) {
    const double reach = two_sided_95_percent * part.sd;
    if (std::abs(low - part.mean) < reach) interval[0] = std::min(interval[0], part.mean - reach);
    if (std::abs(high - part.mean) < reach) interval[1] = std::max(interval[1], part.mean + reach);
  }
  return interval;
}

}  // namespace

std::optional<Measured> bulking_factor(const VolumeChange& change) {
  const bool volume_is_missing =
      std::any_of(change.warnings.begin(), change.warnings.end(), [](const Warning& warning) {
        return warning.code == WarningCode::no_dumped_soil ||
               warning.code == WarningCode::zone_unseen;
      });
  const auto is_volume = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (volume_is_missing || !is_volume(change.before.value) || !is_volume(change.after.value)) {
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

BulkingErrors bulking_errors(const VolumeChange& change) {
  const auto factor = bulking_factor(change);
  if (!factor) return {};
  const Eigen::Vector3d slope = Eigen::Vector3d(-factor->value, 1.0, 1.0) / change.before.value;
  const auto sd = [&](const Eigen::Matrix3d& covariance) {
    return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
  };
  return {sd(change.errors.noise),       sd(change.errors.correlated), sd(change.errors.datum),
          sd(change.errors.holes),       sd(change.errors.faces),      sd(change.errors.thin),
          sd(change.errors.attribution), sd(change.errors.scans())};
}

double variance_by_readings(const VolumeChange& change) {
  if (change.readings.empty()) return 0.0;
  double sum = 0.0;
  double weights = 0.0;
  for (const Reading& reading : change.readings) {
    if (is_unseen(reading)) continue;
    const double off = reading.bulking.value - change.readings.front().bulking.value;
    sum += reading.weight * off * off;
    weights += reading.weight;
  }
  if (!(weights > 0.0)) return 0.0;
  return std::min(sum / weights, std::pow(bulking_errors(change).attribution, 2));
}

std::optional<std::array<double, 2>> bulking_interval(const VolumeChange& change) {
  const auto k = bulking_factor(change);
  if (!k || std::isnan(k->sd)) return std::nullopt;
  const double rest = std::sqrt(std::max(0.0, k->sd * k->sd - variance_by_readings(change)));
  std::vector<NormalPart> parts;
  for (const Reading& reading : change.readings) {
    if (!is_unseen(reading)) parts.push_back({reading.weight, reading.bulking.value, rest});
  }
  if (parts.size() < 2 || !(rest > 0.0)) {
    return std::array<double, 2>{k->value - two_sided_95_percent * k->sd,
                                 k->value + two_sided_95_percent * k->sd};
  }
  return interval_of(parts);
}

double free_of_fallback(double bulking_measured, double fallback_fraction) {
  require(fallback_fraction >= 0.0 && fallback_fraction < 1.0, "fallback fraction",
          fallback_fraction, "at least 0 and below 1");
  require(bulking_measured > 0.0 && std::isfinite(bulking_measured), "measured bulking factor",
          bulking_measured, "positive and finite");
  return fallback_fraction + (1.0 - fallback_fraction) * bulking_measured;
}

}  // namespace excavplan
