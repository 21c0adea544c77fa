// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/hole_filling.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr int unvisited = -2;
constexpr int outside = -3;
constexpr int known = -1;

double squared_rim_step(const Eigen::ArrayXXd& z, const std::vector<Cell>& hole) {
  double sum = 0.0;
  int count = 0;
  for (const Cell inner : hole) {
    for_each_neighbour(z, inner, [&](Cell rim) {
      if (std::isnan(z(rim.row, rim.col))) return;
      for_each_neighbour(z, rim, [&](Cell next) {
        if (std::isnan(z(next.row, next.col))) return;
        const double step = z(next.row, next.col) - z(rim.row, rim.col);
        sum += step * step;
        ++count;
      });
    });
  }
  return count > 0 ? sum / count : 0.0;
}

/// Every filled height is the mean of its four neighbours: one sparse system for all holes. Hole
/// cells never lie on the border, so all of them have four.
void fill(Eigen::ArrayXXd& z, const std::vector<Cell>& unknown) {
  Eigen::ArrayXXi equation = Eigen::ArrayXXi::Constant(z.rows(), z.cols(), -1);
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    equation(unknown[i].row, unknown[i].col) = static_cast<int>(i);
  }
  const auto count = static_cast<Eigen::Index>(unknown.size());
  Eigen::VectorXd known_sum = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(5 * unknown.size());
  for (int i = 0; i < static_cast<int>(count); ++i) {
    entries.emplace_back(i, i, 4.0);
    for_each_neighbour(z, unknown[static_cast<std::size_t>(i)], [&](Cell n) {
      if (const int other = equation(n.row, n.col); other >= 0) {
        entries.emplace_back(i, other, -1.0);
      } else {
        known_sum(i) += z(n.row, n.col);
      }
    });
  }
  Eigen::SparseMatrix<double> membrane(count, count);
  membrane.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd heights =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(membrane).solve(known_sum);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Cell cell = unknown[static_cast<std::size_t>(i)];
    z(cell.row, cell.col) = heights(i);
  }
}

}  // namespace

FilledHoles fill_holes(Eigen::ArrayXXd& z) {
  FilledHoles filled;
  filled.hole = z.isNaN().select(Eigen::ArrayXXi::Constant(z.rows(), z.cols(), unvisited), known);
  const auto any = [](Cell) { return true; };
  for_each_cell(z, [&](Cell cell) {
    if (on_border(z, cell) && filled.hole(cell.row, cell.col) == unvisited) {
      mark_connected(filled.hole, cell, outside, any);
    }
  });
  std::vector<Cell> unknown;
  for_each_cell(z, [&](Cell cell) {
    if (filled.hole(cell.row, cell.col) != unvisited) return;
    const int index = static_cast<int>(filled.holes.size());
    const std::vector<Cell> cells = mark_connected(filled.hole, cell, index, any);
    filled.holes.push_back({static_cast<Eigen::Index>(cells.size()), squared_rim_step(z, cells)});
    unknown.insert(unknown.end(), cells.begin(), cells.end());
  });
  filled.hole = filled.hole.max(known);
  if (!unknown.empty()) fill(z, unknown);
  return filled;
}

}  // namespace excavplan
