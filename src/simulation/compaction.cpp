// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/compaction.hpp>

#include <cmath>

#include "base/check.hpp"
#include "ground/terrain.hpp"
#include "soil/loose_soil.hpp"
#include "soil/soil.hpp"

namespace excavplan {
namespace {

using Eigen::Index;

void require_load(const Load& load) {
  const Rectangle& area = load.area;
  for (const double number : {area.x_min, area.y_min, area.x_max, area.y_max}) {
    require(std::isfinite(number), "compact: a side of the load's area [m]", number, "finite");
  }
  require(area.x_max > area.x_min && area.y_max > area.y_min,
          "compact: the area of a load must not be empty");
  require(load.pressure >= 0.0 && std::isfinite(load.pressure), "compact: the pressure [Pa]",
          load.pressure, "not negative and finite");
  require(load.place.matrix().allFinite(), "compact: the place of a load must be finite");
}

/// Of the load at this depth below it, spread 2 : 1 to all sides [Pa].
double stress(const Load& load, double depth) {
  const double length = load.area.x_max - load.area.x_min;
  const double width = load.area.y_max - load.area.y_min;
  return load.pressure * length * width / ((length + depth) * (width + depth));
}

}  // namespace

void compact(Terrain& terrain, const SoilKind& soil, const Load& load) {
  require_soil(soil);
  require_terrain(terrain, "compact");
  require_load(load);
  const HeightMap& map = terrain.bank;
  Eigen::ArrayXXd& ratio = terrain.loose_void_ratio;
  if (ratio.size() == 0) {
    ratio.setConstant(map.z.rows(), map.z.cols(), soil.void_ratio_loose);
  }
  const Eigen::Isometry2d onto = load.place.inverse();
  for (Index col = 0; col < map.z.cols(); ++col) {
    for (Index row = 0; row < map.z.rows(); ++row) {
      const Eigen::Vector2d at = onto * Eigen::Vector2d(map.x(col), map.y(row));
      double& thickness = terrain.loose(row, col);
      if (!load.area.contains(at.x(), at.y()) || !(thickness > 0.0)) continue;
      const double before = ratio(row, col);
      require_in("compact: the void ratio of loose soil", before, soil.void_ratio_min,
                 soil.void_ratio_loose);
      const double middle = 0.5 * thickness;
      const double own = checked_loose_state(soil, before).unit_weight * middle;
      ratio(row, col) = checked_compaction(soil, before, stress(load, middle) + own);
      thickness *= (1.0 + ratio(row, col)) / (1.0 + before);
    }
  }
}

}  // namespace excavplan
