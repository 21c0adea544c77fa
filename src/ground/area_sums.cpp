// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/area_sums.hpp"

#include <algorithm>

namespace excavplan {

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
