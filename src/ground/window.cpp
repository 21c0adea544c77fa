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

}  // namespace excavplan
