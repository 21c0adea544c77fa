// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <excavplan/change/volume_change.hpp>
#include <excavplan/clouds/cloud.hpp>
#include <excavplan/ground/registration.hpp>

#include "support/survey_scenes.hpp"

/// @file
/// The scenes of survey_scenes.hpp through alignment and volumes. Surfaces and the survey after a
/// registration are made here; survey_registered() makes them from files (benchmarks/accuracy).

namespace excavplan::scenes {

/// Variance of the cells' heights by the scatter of their points about a plane, in some way.
inline Eigen::ArrayXXd scatter_of(const Cloud& cloud, const HeightMap& map) {
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

inline Surface surface_of(const Cloud& cloud, const Rectangle& extent, double cell) {
  RasterOptions options;
  options.cell_size = cell;
  Surface surface;
  surface.height = rasterise(cloud, extent, options);
  surface.variance = scatter_of(cloud, surface.height);
  return surface;
}

/// A dig surveyed once: what is shown, by how many points, and how.
struct Survey {
  Dig dig;
  ScanErrors errors;
  std::size_t points = 1000000;  ///< in all clouds
  std::uint64_t seed = 1;
  bool whole = false;  ///< one scene, else the dig area and the dump area apart

  /// Edge of a cell: twelve points in each, but not below 5 cm.
  double cell(Part part) const {
    const Rectangle extent = extent_of(part);
    const double area = (extent.x_max - extent.x_min) * (extent.y_max - extent.y_min);
    const double in_cloud = static_cast<double>(points / (whole ? 2 : 4));
    return std::max(0.05, 0.01 * std::ceil(100.0 * std::sqrt(12.0 * area / in_cloud)));
  }

  Cloud cloud(Part part, bool after) const {
    Cloud scanned;
    scanned.points = scan(dig, part, errors, points / (whole ? 2 : 4), seed, after);
    scanned.width = scanned.points.size();
    return scanned;
  }

  SurfacePair surveyed(Part part) const {
    const Rectangle extent = extent_of(part);
    const double edge = cell(part);
    SurfacePair pair;
    pair.before = surface_of(cloud(part, false), extent, edge);
    Cloud after = cloud(part, true);
    pair.after = surface_of(after, extent, edge);
    pair.alignment = align(pair.before, pair.after);
    for (int round = 0; round < 3 && pair.alignment.largest_shift(pair.before.height) > 0.5 * edge;
         ++round) {
      transform(after, pair.alignment.correction());
      pair.after = surface_of(after, extent, edge);
      pair.alignment = align(pair.before, pair.after);
    }
    return pair;
  }

  VolumeChange measured() const {
    if (whole) return measure_change(surveyed(Part::whole));
    return measure_change(surveyed(Part::dig), surveyed(Part::dump));
  }
};

}  // namespace excavplan::scenes
