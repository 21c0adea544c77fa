// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/window.hpp"

#include <algorithm>

namespace excavplan {

namespace {

using Eigen::Index;

/// Highest of each column's neighbours within so many columns to both sides. What is highest within
/// a reach is known of each column; of the reach itself and two beside it, it is that of thrice as
/// much.
Eigen::ArrayXXd highest_beside(Eigen::ArrayXXd z, Index cells) {
  const Index last = z.cols() - 1;
  for (Index reach = 0; reach < std::min(cells, last);) {
    const Index shift = std::min(2 * reach + 1, cells - reach);
    const Eigen::ArrayXXd within = z;
    for (Index col = 0; col <= last; ++col) {
      z.col(col) = within.col(col)
                       .max(within.col(std::max<Index>(col - shift, 0)))
                       .max(within.col(std::min(col + shift, last)));
    }
    reach += shift;
  }
  return z;
}

}  // namespace

Eigen::ArrayXXd highest_within(const Eigen::ArrayXXd& z, Index cells) {
  const Eigen::ArrayXXd across = highest_beside(z.transpose(), cells).transpose();
  return highest_beside(across, cells);
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
