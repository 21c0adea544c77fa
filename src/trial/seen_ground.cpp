// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/seen_ground.hpp"

#include <cmath>
#include <limits>

#include "ground/grid_cells.hpp"

namespace excavplan {

void LastSeenGround::take(const Scan& scan) {
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(map_.z.rows(), map_.z.cols());
  Eigen::ArrayXXd count = sum;
  for (const auto& cloud : scan.clouds) {
    for (const Eigen::Vector3d& point : cloud->points) {
      const auto cell = cell_at(map_, point.x(), point.y());
      if (!cell) continue;
      sum(cell->row, cell->col) += point.z();
      count(cell->row, cell->col) += 1.0;
    }
  }
  map_.z = (count > 0.0).select(sum / count, map_.z);
}

double LastSeenGround::at(double x, double y) const {
  const auto cell = cell_at(map_, x, y);
  if (!cell) return std::numeric_limits<double>::quiet_NaN();
  const double here = map_.z(cell->row, cell->col);
  if (!std::isnan(here)) return here;
  constexpr double farthest = 0.5;  // ours [m]
  const auto reach = static_cast<Eigen::Index>(std::ceil(farthest / map_.cell_size));
  double nearest = std::numeric_limits<double>::infinity();
  double height = std::numeric_limits<double>::quiet_NaN();
  for_each_around(map_.z, *cell, reach, [&](Cell near) {
    const double z = map_.z(near.row, near.col);
    const double away = std::hypot(near.row - cell->row, near.col - cell->col);
    if (std::isnan(z) || away >= nearest) return;
    nearest = away;
    height = z;
  });
  return height;
}

}  // namespace excavplan
