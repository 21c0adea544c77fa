// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// A quantity over the cells of a grid.
struct MapLayer {
  std::string name;        ///< ends in its unit: "change_m"; small letters, digits and _
  std::string meaning;     ///< one line, for the description of a GeoTIFF band
  Eigen::ArrayXXd values;  ///< (rows along y, cols along x), NaN where not known
};

/// Layers on one grid.
struct LayeredMap {
  HeightMap ground;  ///< grid of the layers; its heights are z of the points of a PLY file
  std::vector<MapLayer> layers;  ///< each as large as the grid; at least one
};

}  // namespace excavplan
