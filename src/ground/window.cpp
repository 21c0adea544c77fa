// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/window.hpp"

#include <algorithm>

namespace excavplan {

Eigen::ArrayXXd highest_within(const Eigen::ArrayXXd& z, Eigen::Index cells) {
  Eigen::ArrayXXd rows = z;
  for (Eigen::Index shift = 1; shift <= std::min(cells, z.rows() - 1); ++shift) {
    const Eigen::Index n = z.rows() - shift;
    rows.topRows(n) = rows.topRows(n).max(z.bottomRows(n));
    rows.bottomRows(n) = rows.bottomRows(n).max(z.topRows(n));
  }
  Eigen::ArrayXXd both = rows;
  for (Eigen::Index shift = 1; shift <= std::min(cells, z.cols() - 1); ++shift) {
    const Eigen::Index n = z.cols() - shift;
    both.leftCols(n) = both.leftCols(n).max(rows.rightCols(n));
    both.rightCols(n) = both.rightCols(n).max(rows.leftCols(n));
  }
  return both;
}

AreaSums::AreaSums(const Eigen::ArrayXXd& field)
    : sums_(Eigen::ArrayXXd::Zero(field.rows() + 1, field.cols() + 1)) {
  for_each_cell(field, [&](Cell at) {
    sums_(at.row + 1, at.col + 1) = field(at.row, at.col) + sums_(at.row, at.col + 1) +
                                    sums_(at.row + 1, at.col) - sums_(at.row, at.col);
  });
}

double AreaSums::around(Cell at, Eigen::Index radius) const {
  const Eigen::Index top = std::max<Eigen::Index>(at.row - radius, 0);
  const Eigen::Index left = std::max<Eigen::Index>(at.col - radius, 0);
  const Eigen::Index bottom = std::min(at.row + radius + 1, sums_.rows() - 1);
  const Eigen::Index right = std::min(at.col + radius + 1, sums_.cols() - 1);
  return sums_(bottom, right) - sums_(top, right) - sums_(bottom, left) + sums_(top, left);
}

}  // namespace excavplan
