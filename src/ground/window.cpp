// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/window.hpp"

#include <algorithm>
#include <cmath>

namespace excavplan {

namespace {

using Eigen::Index;

// What is highest within a reach is known of each cell; of the reach itself and two beside it, it
// is that of thrice as much. Beyond the first and the last cell these stand for themselves.

/// Calls `widen(shift)` until the reach is so many cells of so many.
template <typename Widen>
void widen_to(Index cells, Index of, Widen widen) {
  for (Index reach = 0; reach < std::min(cells, of - 1);) {
    const Index shift = std::min(2 * reach + 1, cells - reach);
    widen(std::min(shift, of - 1));
    reach += shift;
  }
}

/// Of each column's neighbours within so many columns to both sides.
void take_highest_beside(Eigen::ArrayXXd& z, Index cells) {
  const Index last = z.cols() - 1;
  Eigen::ArrayXXd wide(z.rows(), z.cols());
  widen_to(cells, z.cols(), [&](Index shift) {
    for (Index col = 0; col <= last; ++col) {
      wide.col(col) = z.col(col)
                          .max(z.col(std::max<Index>(col - shift, 0)))
                          .max(z.col(std::min(col + shift, last)));
    }
    z.swap(wide);
  });
}

/// Likewise of each cell's neighbours in its column.
void take_highest_above(Eigen::ArrayXXd& z, Index cells) {
  Eigen::ArrayXd narrow(z.rows());
  for (Index col = 0; col < z.cols(); ++col) {
    auto wide = z.col(col);
    widen_to(cells, z.rows(), [&](Index shift) {
      narrow = wide;
      const Index inner = narrow.size() - shift;
      wide.head(shift) = wide.head(shift).max(narrow(0));
      wide.tail(shift) = wide.tail(shift).max(narrow(narrow.size() - 1));
      wide.tail(inner) = wide.tail(inner).max(narrow.head(inner));
      wide.head(inner) = wide.head(inner).max(narrow.tail(inner));
    });
  }
}

}  // namespace

Eigen::ArrayXXd highest_within(const Eigen::ArrayXXd& z, Index cells) {
  Eigen::ArrayXXd highest = z;
  take_highest_above(highest, cells);
  take_highest_beside(highest, cells);
  return highest;
}

Mask inner_cells(const Eigen::ArrayXXd& share, double cell_size, double margin) {
  constexpr double whole_share = 1.0 - 1e-6;
  constexpr double rounding = 1e-9;
  const Mask whole = share >= whole_share;
  const double apart = margin / cell_size - rounding;
  const auto reach = static_cast<Index>(std::ceil(apart + 0.5));
  Mask inner = whole;
  const auto leave_out_around = [&](Cell outer, double inside) {
    bool is_at_edge = false;
    for_each_around(whole, outer, 1, [&](Cell at) { is_at_edge |= whole(at.row, at.col); });
    if (!is_at_edge) return;
    for_each_around(inner, outer, reach, [&](Cell at) {
      const auto rows = static_cast<double>(at.row - outer.row);
      const auto cols = static_cast<double>(at.col - outer.col);
      if (std::hypot(rows, cols) - 0.5 + inside < apart) inner(at.row, at.col) = false;
    });
  };
  for (Index col = -1; col <= share.cols(); ++col) {
    for (Index row = -1; row <= share.rows(); ++row) {
      const bool is_on_grid = row >= 0 && col >= 0 && row < share.rows() && col < share.cols();
      if (!is_on_grid) leave_out_around({row, col}, 0.0);
      if (is_on_grid && !whole(row, col))
        leave_out_around({row, col}, std::max(0.0, share(row, col)));
    }
  }
  return inner;
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
