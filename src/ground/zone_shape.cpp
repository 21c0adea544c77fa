// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/zone_shape.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "ground/grid_cells.hpp"
#include "ground/robust.hpp"

namespace excavplan {
namespace {

double slope_at(const Eigen::ArrayXXd& d, Cell at, double cell_size) {
  const auto along = [&](Eigen::Index dr, Eigen::Index dc) {
    const Eigen::Index r0 = std::max<Eigen::Index>(at.row - dr, 0);
    const Eigen::Index c0 = std::max<Eigen::Index>(at.col - dc, 0);
    const Eigen::Index r1 = std::min(at.row + dr, d.rows() - 1);
    const Eigen::Index c1 = std::min(at.col + dc, d.cols() - 1);
    const double rise = (d(r1, c1) - d(r0, c0)) / (2.0 * cell_size);
    return std::isnan(rise) ? 0.0 : rise;
  };
  return std::hypot(along(1, 0), along(0, 1));
}

/// Mean |D| of the far half of a tail over that of its near half, by distance from its parent.
double lasting_of(const Area& area, std::size_t tail, const std::vector<Cell>& cells) {
  const int parent = area.parts.parent[tail];
  const Eigen::ArrayXXd away = distance_to(area.ground.zone == parent);
  std::vector<double> distances;
  for (const Cell at : cells) distances.push_back(away(at.row, at.col));
  const double middle = median(distances);
  double sums[2] = {0.0, 0.0};
  double counts[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int far = distances[i] > middle ? 1 : 0;
    sums[far] += std::abs(area.ground.difference(cells[i].row, cells[i].col));
    counts[far] += 1.0;
  }
  return counts[1] > 0.0 && sums[0] > 0.0 ? sums[1] / counts[1] / (sums[0] / counts[0]) : 1.0;
}

ZoneShape shape_of(const Area& area, const std::vector<Cell>& cells) {
  ZoneShape shape;
  double sum = 0.0;
  double squares = 0.0;
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  std::vector<double> slopes;
  for (const Cell at : cells) {
    const double d = std::abs(area.ground.difference(at.row, at.col));
    const Eigen::Vector2d place(area.grid.x(at.col), area.grid.y(at.row));
    sum += d;
    squares += d * d;
    shape.centre += d * place;
    slopes.push_back(slope_at(area.ground.difference, at, area.grid.cell_size));
  }
  if (!(sum > 0.0)) return shape;
  shape.centre /= sum;
  shape.height = squares / sum;
  for (const Cell at : cells) {
    const double d = std::abs(area.ground.difference(at.row, at.col));
    const Eigen::Vector2d off =
        Eigen::Vector2d(area.grid.x(at.col), area.grid.y(at.row)) - shape.centre;
    products += d / sum * off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(products);
  shape.axis = axes.eigenvectors().col(1);
  shape.width = std::sqrt(12.0 * std::max(axes.eigenvalues()(0), 0.0));
  shape.length = std::sqrt(12.0 * std::max(axes.eigenvalues()(1), 0.0));
  const auto tenth = slopes.begin() + static_cast<std::ptrdiff_t>(9 * slopes.size() / 10);
  std::nth_element(slopes.begin(), tenth, slopes.end());
  shape.steepest = *tenth;
  return shape;
}

}  // namespace

std::vector<ZoneShape> shapes_of(const Area& area) {
  std::vector<std::vector<Cell>> cells(area.zones.size());
  for_each_cell(area.ground.zone, [&](Cell at) {
    const int index = area.ground.zone(at.row, at.col);
    if (index >= 0) cells[static_cast<std::size_t>(index)].push_back(at);
  });
  std::vector<ZoneShape> shapes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    shapes.push_back(shape_of(area, cells[i]));
    if (area.parts.part[i] == Part::tail && !cells[i].empty()) {
      shapes.back().lasting = lasting_of(area, i, cells[i]);
    }
  }
  return shapes;
}

}  // namespace excavplan
