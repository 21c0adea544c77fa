// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/frame_average.hpp"

#include <cmath>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

// Ours.
constexpr double ray_tolerance = 0.002;    // [rad]
constexpr double most_off_rays = 0.05;     // of the pixels seen twice
constexpr double least_deviation = 0.001;  // that is left out, a count of most depth cameras [m]

}  // namespace

bool FrameAverage::add(const std::vector<Eigen::Vector3d>& points) {
  rays_.resize(points.size(), Eigen::Vector3d::Zero());
  std::size_t seen_twice = 0;
  std::size_t off_rays = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double range = points[i].norm();
    if (!std::isfinite(range) || rays_[i].isZero(0.0)) continue;
    ++seen_twice;
    if ((points[i] - range * rays_[i]).norm() > ray_tolerance * range) ++off_rays;
  }
  if (static_cast<double>(off_rays) > most_off_rays * static_cast<double>(seen_twice)) return false;
  std::vector<float>& ranges = frames_.emplace_back();
  ranges.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double range = points[i].norm();
    const bool is_seen = std::isfinite(range) && range > 0.0;
    if (is_seen && rays_[i].isZero(0.0)) rays_[i] = points[i] / range;
    ranges.push_back(static_cast<float>(is_seen ? range : nan));
  }
  return true;
}

AveragedFrames FrameAverage::result() const {
  AveragedFrames average;
  std::vector<double> of_pixel;
  std::vector<double> deviations;
  for (std::size_t pixel = 0; pixel < rays_.size(); ++pixel) {
    of_pixel.clear();
    for (const std::vector<float>& ranges : frames_) {
      if (std::isfinite(ranges[pixel])) of_pixel.push_back(ranges[pixel]);
    }
    const RobustMean mean = robust_mean(of_pixel, least_deviation);
    const bool is_known =
        mean.count > 0 && 2 * static_cast<std::size_t>(mean.count) >= frames_.size();
    average.points.push_back(is_known ? Eigen::Vector3d(mean.value * rays_[pixel])
                                      : Eigen::Vector3d::Constant(nan));
    const bool has_variance = is_known && mean.count > 1;
    average.variance.push_back(has_variance ? mean.variance / mean.count : nan);
    if (has_variance) deviations.push_back(std::sqrt(mean.variance));
  }
  if (!deviations.empty()) average.frame_sd = mean_median(deviations);
  return average;
}

}  // namespace excavplan
