// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/design/job_design.hpp>
#include <excavplan/ground/height_map.hpp>

#include "base/plan_geometry.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {

/// The cells whose centre lies in a polygon.
inline Mask cells_in(const SitePolygon& polygon, const HeightMap& grid) {
  Mask mask = Mask::Constant(grid.z.rows(), grid.z.cols(), false);
  for_each_cell(mask, [&](Cell at) {
    mask(at.row, at.col) = is_inside(polygon, {grid.x(at.col), grid.y(at.row)});
  });
  return mask;
}

}  // namespace excavplan
