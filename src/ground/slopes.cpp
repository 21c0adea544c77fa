// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/non_finite.hpp"

namespace excavplan {

Gradient gradient_of(const HeightMap& map) {
  Gradient gradient;
  gradient.x = Eigen::ArrayXXd::Constant(map.z.rows(), map.z.cols(),
                                         std::numeric_limits<double>::quiet_NaN());
  gradient.y = gradient.x;
  const Eigen::Index rows = map.z.rows() - 2;
  const Eigen::Index cols = map.z.cols() - 2;
  if (rows < 1 || cols < 1) return gradient;
  const auto& z = map.z;
  const Eigen::ArrayXXd along = z.topRows(rows) + z.middleRows(1, rows) + z.bottomRows(rows);
  const Eigen::ArrayXXd across = z.leftCols(cols) + z.middleCols(1, cols) + z.rightCols(cols);
  gradient.x.block(1, 1, rows, cols) =
      (along.rightCols(cols) - along.leftCols(cols)) / (6.0 * map.cell_size) +
      0.0 * along.middleCols(1, cols);
  gradient.y.block(1, 1, rows, cols) =
      (across.bottomRows(rows) - across.topRows(rows)) / (6.0 * map.cell_size) +
      0.0 * across.middleRows(1, rows);
  return gradient;
}

Eigen::ArrayXXd slope_limited(const Eigen::ArrayXXd& z, double rise) {
  const double diagonal = rise * std::sqrt(2.0);
  Eigen::ArrayXXd limit = z.isNaN().select(infinity, z);
  const auto lower = [&](Eigen::Index row, Eigen::Index col, Eigen::Index step) {
    double& here = limit(row, col);
    const auto from = [&](Eigen::Index r, Eigen::Index c, double way) {
      if (r < 0 || c < 0 || r >= z.rows() || c >= z.cols()) return;
      here = std::min(here, limit(r, c) + way);
    };
    from(row - step, col, rise);
    from(row, col - step, rise);
    from(row - step, col - step, diagonal);
    from(row + step, col - step, diagonal);
  };
  for (Eigen::Index col = 0; col < z.cols(); ++col) {
    for (Eigen::Index row = 0; row < z.rows(); ++row) lower(row, col, 1);
  }
  for (Eigen::Index col = z.cols() - 1; col >= 0; --col) {
    for (Eigen::Index row = z.rows() - 1; row >= 0; --row) lower(row, col, -1);
  }
  return limit;
}

Eigen::ArrayXXd distance_to(const Mask& marked) {
  const Eigen::ArrayXXd start = marked.select(Eigen::ArrayXXd::Zero(marked.rows(), marked.cols()),
                                              std::numeric_limits<double>::infinity());
  return slope_limited(start, 1.0);
}

}  // namespace excavplan
