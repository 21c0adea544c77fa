// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

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
Eigen::ArrayXXd scatter_of(const Cloud& cloud, const HeightMap& map);

Surface surface_of(const Cloud& cloud, const Rectangle& extent, double cell);

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
