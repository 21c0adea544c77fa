// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/law_curve.hpp"

#include "base/statistics.hpp"

namespace excavplan {
namespace {

constexpr int steps = 100;

}  // namespace

Points law_curve(const DensityForm& form) {
  Points points;
  for (int i = 0; i <= steps; ++i) {
    const double d = 100.0 * i / steps;
    points.emplace_back(bulking_of_density(form, d), d);
  }
  return points;
}

Points law_band(const DensityForm& form) {
  Points above;
  Points below;
  for (const Eigen::Vector2d& point : law_curve(form)) {
    const double half = two_sided_95_percent * residual_sd_at(form, point.y());
    above.emplace_back(point.x(), point.y() + half);
    below.emplace_back(point.x(), point.y() - half);
  }
  above.insert(above.end(), below.rbegin(), below.rend());
  return above;
}

}  // namespace excavplan
