// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/map_check.hpp"

#include <cmath>
#include <string>

#include "base/check.hpp"

namespace excavplan {
namespace {

constexpr double smallest_cell = 1e-6;    // [m]
constexpr double largest_cell = 1e6;      // [m]
constexpr double farthest_place = 1e9;    // of a map from the origin [m]
constexpr std::size_t most_sensors = 31;  // a bit each in Surface::seen_from

void in(const char* what, const char* member, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return;
  require_in(std::string(what) + ": " + member, value, lowest, highest);
}

template <typename Layer>
void require_size(const HeightMap& map, const Layer& layer, const char* what, const char* name) {
  if (layer.size() == 0) return;
  if (layer.rows() == map.z.rows() && layer.cols() == map.z.cols()) return;
  refuse(std::string(what) + ": " + name + " has " + std::to_string(layer.rows()) + " x " +
         std::to_string(layer.cols()) + " cells, must have as many as the heights, " +
         std::to_string(map.z.rows()) + " x " + std::to_string(map.z.cols()));
}

}  // namespace

void require_grid(const HeightMap& map, const char* what) {
  if (map.z.size() == 0) refuse(std::string(what) + ": the map is empty");
  in(what, "cell size [m]", map.cell_size, smallest_cell, largest_cell);
  in(what, "x of the map's origin [m]", map.origin.x(), -farthest_place, farthest_place);
  in(what, "y of the map's origin [m]", map.origin.y(), -farthest_place, farthest_place);
}

void require_map(const HeightMap& map, const char* what) {
  require_grid(map, what);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) {
    const double z = map.z(i);
    if (!(std::abs(z) > farthest_height)) continue;
    in(what, "a height [m]", z, -farthest_height, farthest_height);
  }
}

void require_surface(const Surface& surface, const char* what) {
  require_map(surface.height, what);
  require_size(surface.height, surface.variance, what, "variance");
  require_size(surface.height, surface.points, what, "points");
  require_size(surface.height, surface.seen_from, what, "seen_from");
  require_size(surface.height, surface.doubt, what, "doubt");
  require_size(surface.height, surface.outlier_bias, what, "outlier_bias");
  require_size(surface.height, surface.below, what, "below");
  in(what, "number of sensors", static_cast<double>(surface.sensors.size()), 0.0, most_sensors);
  for (const Eigen::Vector3d& place : surface.sensors) {
    for (const double number : place) {
      in(what, "place of a sensor [m]", number, -farthest_place, farthest_place);
    }
  }
}

}  // namespace excavplan
