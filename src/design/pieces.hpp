// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include <excavplan/design/design_surface.hpp>

#include "ground/grid_cells.hpp"

/// @file A design cut along the cells of a grid. Heights are carried on from corner to corner, so
/// that steep and upright faces lose nothing. Private to the library.

namespace excavplan {

/// A convex plane polygon, x and y from the corner of a grid.
struct Piece {
  std::array<Eigen::Vector3d, 12> corners;  ///< four of a cell and eight cuts at most
  std::size_t count = 0;

  void add(const Eigen::Vector3d& corner) { corners[count++] = corner; }
  bool is_empty() const { return count < 3; }
  double lowest(Eigen::Index axis) const {
    double least = corners[0][axis];
    for (std::size_t i = 1; i < count; ++i) least = std::min(least, corners[i][axis]);
    return least;
  }
  double highest(Eigen::Index axis) const {
    double most = corners[0][axis];
    for (std::size_t i = 1; i < count; ++i) most = std::max(most, corners[i][axis]);
    return most;
  }
};

/// The part on one side of a plane across an axis: `side` 1 keeps what lies below the limit, -1
/// what lies above it.
inline Piece part_of(const Piece& piece, Eigen::Index axis, double limit, double side) {
  Piece part;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Eigen::Vector3d& a = piece.corners[i];
    const Eigen::Vector3d& b = piece.corners[i + 1 < piece.count ? i + 1 : 0];
    const double of_a = side * (limit - a[axis]);
    const double of_b = side * (limit - b[axis]);
    if (of_a >= 0.0) part.add(a);
    if ((of_a > 0.0 && of_b < 0.0) || (of_a < 0.0 && of_b > 0.0)) {
      Eigen::Vector3d cut = a + of_a / (of_a - of_b) * (b - a);
      cut[axis] = limit;
      part.add(cut);
    }
  }
  return part;
}

/// The part between two planes across an axis.
inline Piece part_between(const Piece& piece, Eigen::Index axis, double low, double high) {
  const Piece below = piece.highest(axis) > high ? part_of(piece, axis, high, 1.0) : piece;
  const bool is_inside = below.is_empty() || below.lowest(axis) >= low;
  return is_inside ? below : part_of(below, axis, low, -1.0);
}

/// Area in plan, and the integral of the heights over it.
struct PieceSum {
  double area = 0.0;    ///< [m^2], >= 0
  double volume = 0.0;  ///< [m^3]
};
inline PieceSum sum_of(const Piece& piece) {
  PieceSum sum;
  const Eigen::Vector3d& o = piece.corners[0];
  for (std::size_t i = 2; i < piece.count; ++i) {
    const Eigen::Vector3d a = piece.corners[i - 1] - o;
    const Eigen::Vector3d b = piece.corners[i] - o;
    const double area = 0.5 * (a.x() * b.y() - a.y() * b.x());
    sum.area += area;
    sum.volume += area * (o.z() + (a.z() + b.z()) / 3.0);
  }
  if (sum.area < 0.0) return {-sum.area, -sum.volume};
  return sum;
}

/// Calls `visit` with each triangle, or each known cell of a raster.
template <typename Visit>
void for_each_face(const DesignSurface& design, const HeightMap& grid, Visit visit) {
  const Eigen::Vector3d corner(grid.origin.x(), grid.origin.y(), 0.0);
  if (const Tin* const tin = std::get_if<Tin>(&design.shape)) {
    const Eigen::Vector3d shift = tin->origin - corner;
    for (const auto& triangle : tin->triangles) {
      Piece piece;
      for (const std::uint32_t point : triangle) piece.add(tin->points[point] + shift);
      visit(piece);
    }
    return;
  }
  const auto& map = std::get<HeightMap>(design.shape);
  const double cell = map.cell_size;
  const Eigen::Vector2d shift = map.origin - grid.origin;
  for_each_cell(map.z, [&](Cell at) {
    const double z = map.z(at.row, at.col);
    if (std::isnan(z)) return;
    const double x = shift.x() + cell * static_cast<double>(at.col);
    const double y = shift.y() + cell * static_cast<double>(at.row);
    Piece piece;
    piece.add({x, y, z});
    piece.add({x + cell, y, z});
    piece.add({x + cell, y + cell, z});
    piece.add({x, y + cell, z});
    visit(piece);
  });
}

/// The cells between two places along an axis, as far as there are so many.
struct CellSpan {
  CellSpan(const Piece& piece, Eigen::Index axis, double cell, Eigen::Index cells) {
    const auto most = static_cast<double>(cells);
    first = static_cast<Eigen::Index>(std::clamp(std::floor(piece.lowest(axis) / cell), 0.0, most));
    end = static_cast<Eigen::Index>(std::clamp(std::ceil(piece.highest(axis) / cell), 0.0, most));
    // What lies on a line between two cells is in the one beyond it.
    if (first == end && piece.lowest(axis) >= 0.0 && end < cells) ++end;
  }
  Eigen::Index first;
  Eigen::Index end;
};

/// Calls `visit` with each cell of the grid and what of a face lies in it.
template <typename Visit>
void for_each_part(const Piece& face, const HeightMap& grid, Visit visit) {
  const double cell = grid.cell_size;
  const CellSpan rows(face, 1, cell, grid.z.rows());
  for (Eigen::Index row = rows.first; row < rows.end; ++row) {
    const double low = cell * static_cast<double>(row);
    const double high = cell * static_cast<double>(row + 1);
    const Piece strip = part_between(face, 1, low, high);
    if (strip.is_empty()) continue;
    const CellSpan cols(strip, 0, cell, grid.z.cols());
    for (Eigen::Index col = cols.first; col < cols.end; ++col) {
      const double left = cell * static_cast<double>(col);
      const double right = cell * static_cast<double>(col + 1);
      const Piece part = part_between(strip, 0, left, right);
      if (!part.is_empty()) visit(Cell{row, col}, part);
    }
  }
}

}  // namespace excavplan
