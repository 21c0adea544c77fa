// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <excavplan/trial/hidden_site.hpp>

#include "ground/grid_cells.hpp"

namespace excavplan {

/// When the cells of the true ground were seen if its first scan was made at a time; NaN: never
/// [s].
inline Eigen::ArrayXXd seen_at_first(const HiddenSite& site, double time) {
  const HeightMap& grid = site.ground.bank;
  Eigen::ArrayXXd seen = Eigen::ArrayXXd::Constant(grid.z.rows(), grid.z.cols(),
                                                   std::numeric_limits<double>::quiet_NaN());
  for_each_cell(seen, [&](Cell at) {
    const auto cell = cell_at(site.first_scan, grid.x(at.col), grid.y(at.row));
    if (!cell || std::isnan(site.first_scan.z(cell->row, cell->col))) return;
    seen(at.row, at.col) = time;
  });
  return seen;
}

}  // namespace excavplan
