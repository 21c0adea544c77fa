// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace excavplan {

/// A block of cells, upper ends exclusive.
struct CellBlock {
  Eigen::Index row_begin = 0;
  Eigen::Index row_end = 0;
  Eigen::Index col_begin = 0;
  Eigen::Index col_end = 0;

  void include(const CellBlock& other) {
    if (other.empty()) return;
    if (empty()) {
      *this = other;
      return;
    }
    row_begin = std::min(row_begin, other.row_begin);
    row_end = std::max(row_end, other.row_end);
    col_begin = std::min(col_begin, other.col_begin);
    col_end = std::max(col_end, other.col_end);
  }
  bool contains(Eigen::Index row, Eigen::Index col) const {
    return row >= row_begin && row < row_end && col >= col_begin && col < col_end;
  }
  bool contains(const CellBlock& other) const {
    return other.empty() || (other.row_begin >= row_begin && other.row_end <= row_end &&
                             other.col_begin >= col_begin && other.col_end <= col_end);
  }
  bool empty() const { return row_begin >= row_end || col_begin >= col_end; }
  Eigen::Index rows() const { return row_end - row_begin; }
  Eigen::Index cols() const { return col_end - col_begin; }
  /// This block and `margin` cells around it.
  CellBlock around(Eigen::Index margin) const {
    return {row_begin - margin, row_end + margin, col_begin - margin, col_end + margin};
  }
  /// The cells of both blocks.
  CellBlock common(const CellBlock& other) const {
    return {std::max(row_begin, other.row_begin), std::min(row_end, other.row_end),
            std::max(col_begin, other.col_begin), std::min(col_end, other.col_end)};
  }
  /// This block and `margin` cells around it, as far as a map of this size has them.
  CellBlock widened(Eigen::Index margin, Eigen::Index map_rows, Eigen::Index map_cols) const;
};

}  // namespace excavplan
