// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/soil_simulator.hpp>

#include <cmath>

namespace excavplan {

HeightMap Terrain::surface() const {
  HeightMap map = bank;
  map.z += loose;
  return map;
}

Terrain undisturbed(const HeightMap& surface) {
  return {surface, Eigen::ArrayXXd::Zero(surface.z.rows(), surface.z.cols())};
}

HeightMapVolumes height_map_volumes(const Terrain& before, const Terrain& after,
                                    const Eigen::Vector2d& dump_at, double dump_radius) {
  const HeightMap from = before.surface();
  const HeightMap to = after.surface();
  HeightMapVolumes volumes;
  for (Eigen::Index col = 0; col < from.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < from.z.rows(); ++row) {
      const double rise = (to.z(row, col) - from.z(row, col)) * from.cell * from.cell;
      if (std::isnan(rise)) continue;
      const bool heap =
          std::hypot(from.x(col) - dump_at.x(), from.y(row) - dump_at.y()) <= dump_radius;
      if (rise < 0.0) {
        volumes.excavated -= rise;
      } else {
        (heap ? volumes.dumped : volumes.spilled) += rise;
      }
    }
  }
  if (volumes.excavated > 0.0) {
    volumes.bulking_factor = (volumes.spilled + volumes.dumped) / volumes.excavated;
  }
  return volumes;
}

}  // namespace excavplan
