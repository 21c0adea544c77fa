// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <excavplan/design/job_design.hpp>
#include <excavplan/ground/height_map.hpp>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// Whether a place lies in a polygon.
inline bool is_in(const SitePolygon& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[k];
    if ((a.y() > y) == (b.y() > y)) continue;
    if (x < a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

/// The cells whose centre lies in a polygon.
inline Mask cells_in(const SitePolygon& polygon, const HeightMap& grid) {
  Mask mask = Mask::Constant(grid.z.rows(), grid.z.cols(), false);
  for_each_cell(mask, [&](Cell at) {
    mask(at.row, at.col) = is_in(polygon, grid.x(at.col), grid.y(at.row));
  });
  return mask;
}

}  // namespace excavplan
