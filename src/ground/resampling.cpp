// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/resampling.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

constexpr double rounding = 1e-9;  // of a cell

/// Unknown cells in a row through one of them, which lies in a hole.
/// @param step  (0, 1) along x, (1, 0) along y
Eigen::Index gap_along(const Eigen::ArrayXXd& z, Cell at, Cell step) {
  Eigen::Index count = 1;
  for (const Eigen::Index way : {-1, 1}) {
    Cell next{at.row + way * step.row, at.col + way * step.col};
    for (; std::isnan(z(next.row, next.col)); ++count) {
      next = {next.row + way * step.row, next.col + way * step.col};
    }
  }
  return count;
}

}  // namespace

HeightMap resampled(const HeightMap& map, const Rectangle& extent, double cell_size,
                    double widest_gap) {
  require_map(map, "resampled");
  require(widest_gap >= 0.0, "resampled: widest gap", widest_gap, "at least 0 m");
  HeightMap whole = map;
  const double most = std::floor(widest_gap / map.cell_size + rounding);
  for (const std::vector<Cell>& hole : fill_holes(whole.z).cells) {
    for (const Cell& at : hole) {
      const auto width = std::min(gap_along(map.z, at, {0, 1}), gap_along(map.z, at, {1, 0}));
      if (static_cast<double>(width) > most) whole.z(at.row, at.col) = nan;
    }
  }
  HeightMap result = flat_ground(extent, cell_size);
  for_each_cell(result.z, [&](Cell at) {
    result.z(at.row, at.col) = height_at(whole, result.x(at.col), result.y(at.row));
  });
  return result;
}

double unseen_area(const HeightMap& map) {
  require_grid(map, "unseen area");
  Eigen::Index cells = 0;
  for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
    Eigen::Index unknown = 0;
    bool begun = false;
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      if (std::isnan(map.z(row, col))) {
        unknown += begun ? 1 : 0;
      } else {
        begun = true;
        cells += unknown;
        unknown = 0;
      }
    }
  }
  return static_cast<double>(cells) * map.cell_size * map.cell_size;
}

}  // namespace excavplan
