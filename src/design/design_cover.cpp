// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/design_surface.hpp>

#include <limits>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "design/pieces.hpp"
#include "ground/map_check.hpp"

namespace excavplan {

Rectangle extent_of(const DesignSurface& design) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Rectangle all = {endless, endless, -endless, -endless};
  for_each_face(design, HeightMap{}, [&all](const Piece& face) {
    all.x_min = std::min(all.x_min, face.lowest(0));
    all.x_max = std::max(all.x_max, face.highest(0));
    all.y_min = std::min(all.y_min, face.lowest(1));
    all.y_max = std::max(all.y_max, face.highest(1));
  });
  require(all.x_max >= all.x_min, "design " + in_quotes(design.name) + ": it has no face");
  return all;
}

double area_in_plan(const DesignSurface& design) {
  HeightMap near;  // so that the differences of coordinates are those of the points themselves
  if (const Tin* const tin = std::get_if<Tin>(&design.shape)) near.origin = tin->origin.head<2>();
  double area = 0.0;
  for_each_face(design, near, [&area](const Piece& face) { area += sum_of(face).area; });
  return area;
}

DesignCover cover_of(const DesignSurface& design, const HeightMap& grid) {
  require_grid(grid, "design: the grid");
  DesignCover cover;
  cover.height = Eigen::ArrayXXd::Zero(grid.z.rows(), grid.z.cols());
  cover.share = cover.height;
  for_each_face(design, grid, [&](const Piece& face) {
    for_each_part(face, grid, [&](Cell at, const Piece& part) {
      const PieceSum sum = sum_of(part);
      cover.share(at.row, at.col) += sum.area;
      cover.height(at.row, at.col) += sum.volume;
    });
  });
  cover.height = (cover.share > 0.0).select(cover.height / cover.share, nan);
  cover.share /= grid.cell_size * grid.cell_size;
  return cover;
}

}  // namespace excavplan
