// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/measured_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace excavplan::scenes {

Eigen::ArrayXXd scatter_of(const Cloud& cloud, const HeightMap& map) {
  std::vector<Eigen::Matrix4d> moments(static_cast<std::size_t>(map.z.size()),
                                       Eigen::Matrix4d::Zero());
  for (const Eigen::Vector3d& p : cloud.points) {
    const double u = (p.x() - map.origin.x()) / map.cell_size;
    const double v = (p.y() - map.origin.y()) / map.cell_size;
    if (!(u >= 0.0 && v >= 0.0)) continue;
    const auto col = static_cast<Eigen::Index>(u);
    const auto row = static_cast<Eigen::Index>(v);
    if (col >= map.z.cols() || row >= map.z.rows()) continue;
    const double z = p.z() - map.z(row, col);
    if (!(std::abs(z) < 0.3)) continue;
    const Eigen::Vector4d one(1.0, u - static_cast<double>(col) - 0.5,
                              v - static_cast<double>(row) - 0.5, z);
    moments[static_cast<std::size_t>(col * map.z.rows() + row)] += one * one.transpose();
  }
  Eigen::ArrayXXd variance = map.z;
  for (Eigen::Index i = 0; i < map.z.size(); ++i) {
    const Eigen::Matrix4d& m = moments[static_cast<std::size_t>(i)];
    variance(i) = std::numeric_limits<double>::quiet_NaN();
    if (m(0, 0) < 2.0) continue;
    if (m(0, 0) < 8.0) {
      const double mean = m(0, 3) / m(0, 0);
      variance(i) = std::max(0.0, m(3, 3) / m(0, 0) - mean * mean) / (m(0, 0) - 1.0);
      continue;
    }
    const Eigen::Vector3d plane = m.topLeftCorner<3, 3>().ldlt().solve(m.topRightCorner<3, 1>());
    const double left = m(3, 3) - plane.dot(m.topRightCorner<3, 1>());
    variance(i) = std::max(0.0, left) / (m(0, 0) - 3.0) / m(0, 0);
  }
  return variance;
}

Surface surface_of(const Cloud& cloud, const Rectangle& extent, double cell) {
  RasterOptions options;
  options.cell_size = cell;
  Surface surface;
  surface.height = rasterise(cloud, extent, options);
  surface.variance = scatter_of(cloud, surface.height);
  return surface;
}

}  // namespace excavplan::scenes
