// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

/// @file
/// Visiting the cells of a grid. Private to the project.

namespace excavplan {

using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

struct Cell {
  Eigen::Index row;
  Eigen::Index col;
};

/// The cell that holds a place; nothing outside the map.
inline std::optional<Cell> cell_at(const HeightMap& grid, double x, double y) {
  const double col = std::floor((x - grid.origin.x()) / grid.cell_size);
  const double row = std::floor((y - grid.origin.y()) / grid.cell_size);
  const bool inside = col >= 0.0 && col < static_cast<double>(grid.z.cols()) && row >= 0.0 &&
                      row < static_cast<double>(grid.z.rows());
  if (!inside) return std::nullopt;
  return Cell{static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)};
}

template <typename Array, typename Visit>
void for_each_cell(const Array& grid, Visit visit) {
  for (Eigen::Index col = 0; col < grid.cols(); ++col) {
    for (Eigen::Index row = 0; row < grid.rows(); ++row) visit(Cell{row, col});
  }
}

/// The up to four cells that share an edge with `cell`.
template <typename Array, typename Visit>
void for_each_neighbour(const Array& grid, Cell cell, Visit visit) {
  if (cell.row > 0) visit(Cell{cell.row - 1, cell.col});
  if (cell.row + 1 < grid.rows()) visit(Cell{cell.row + 1, cell.col});
  if (cell.col > 0) visit(Cell{cell.row, cell.col - 1});
  if (cell.col + 1 < grid.cols()) visit(Cell{cell.row, cell.col + 1});
}

/// The cells of a square around `cell`, itself included, as far as the grid reaches.
template <typename Array, typename Visit>
void for_each_around(const Array& grid, Cell cell, Eigen::Index radius, Visit visit) {
  const Eigen::Index end_col = std::min(cell.col + radius + 1, grid.cols());
  const Eigen::Index end_row = std::min(cell.row + radius + 1, grid.rows());
  for (Eigen::Index col = std::max<Eigen::Index>(cell.col - radius, 0); col < end_col; ++col) {
    for (Eigen::Index row = std::max<Eigen::Index>(cell.row - radius, 0); row < end_row; ++row) {
      visit(Cell{row, col});
    }
  }
}

template <typename Array>
bool on_border(const Array& grid, Cell cell) {
  return cell.row == 0 || cell.col == 0 || cell.row + 1 == grid.rows() ||
         cell.col + 1 == grid.cols();
}

/// The values that are not NaN.
inline std::vector<double> known_values(const Eigen::ArrayXXd& grid) {
  std::vector<double> known;
  for (const double value : grid.reshaped()) {
    if (!std::isnan(value)) known.push_back(value);
  }
  return known;
}

/// Gives `mark` to the edge-connected cells around `seed` whose label is `free` and which `joins`
/// accepts, and returns them.
template <typename Joins>
std::vector<Cell> mark_connected(Eigen::ArrayXXi& label, Cell seed, int mark, Joins joins) {
  const int free = label(seed.row, seed.col);
  std::vector<Cell> cells = {seed};
  label(seed.row, seed.col) = mark;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    for_each_neighbour(label, cells[next], [&](Cell n) {
      if (label(n.row, n.col) != free || !joins(n)) return;
      label(n.row, n.col) = mark;
      cells.push_back(n);
    });
  }
  return cells;
}

}  // namespace excavplan
