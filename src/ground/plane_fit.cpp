// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/plane_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"

namespace excavplan {

Eigen::Vector3d PlaneFit::mean() const {
  return {equations_.matrix()(0, 1) / count(), equations_.matrix()(0, 2) / count(),
          equations_.right()(0) / count()};
}

double PlaneFit::squares_about(const GroundPlane& plane) const {
  return std::max(0.0, equations_.squares_about(plane.terms));
}

RobustPlane robust_plane(const std::vector<Eigen::Vector3d>& points) {
  constexpr int rounds = 4;
  constexpr double clip = 2.5;  // robust standard deviations
  RobustPlane fit;
  fit.sd = std::numeric_limits<double>::infinity();
  std::vector<double> away;
  for (int round = 0; round < rounds; ++round) {
    const auto distance = [&fit](const Eigen::Vector3d& p) {
      return std::abs(p.z() - fit.plane.at(p.x(), p.y()));
    };
    PlaneFit near;
    for (const Eigen::Vector3d& p : points) {
      if (distance(p) <= clip * fit.sd) near.add(p.x(), p.y(), p.z());
    }
    fit.plane = near.plane();
    away.clear();
    for (const Eigen::Vector3d& p : points) away.push_back(distance(p));
    fit.sd = robust_sd(away);
  }
  return fit;
}

}  // namespace excavplan
