// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <variant>

#include <excavplan/design/design_words.hpp>
#include <excavplan/estimating/job_estimate.hpp>

#include "base/check.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

constexpr double steep = 0.36397023426620234;  // tangent of 20 degrees; ours

/// Area in plan, and of it that of steep faces [m^2].
struct Faces {
  double area = 0.0;
  double steep = 0.0;

  void add(double size, double slope) {
    area += size;
    if (slope > excavplan::steep) steep += size;
  }
};

Faces faces_of(const Tin& tin) {
  Faces faces;
  for (const auto& corners : tin.triangles) {
    const Eigen::Vector3d& a = tin.points[corners[0]];
    const Eigen::Vector3d normal = (tin.points[corners[1]] - a).cross(tin.points[corners[2]] - a);
    const double in_plan = std::abs(normal.z());
    if (in_plan > 0.0) faces.add(0.5 * in_plan, normal.head<2>().norm() / in_plan);
  }
  return faces;
}

Faces faces_of(const HeightMap& map) {
  Faces faces;
  const double cell = map.cell_size;
  for_each_cell(map.z, [&](Cell at) {
    const double z = map.z(at.row, at.col);
    if (std::isnan(z)) return;
    const auto slope_to = [&](Eigen::Index row, Eigen::Index col) {
      const bool is_there = row < map.z.rows() && col < map.z.cols();
      const double rise = is_there ? std::abs(map.z(row, col) - z) : 0.0;
      return std::isnan(rise) ? 0.0 : rise / cell;
    };
    faces.add(cell * cell, std::hypot(slope_to(at.row + 1, at.col), slope_to(at.row, at.col + 1)));
  });
  return faces;
}

/// Calls `visit` with the places of a design in plan.
template <typename Visit>
void for_each_place(const DesignSurface& design, const Visit& visit) {
  if (const auto* tin = std::get_if<Tin>(&design.shape)) {
    for (const Eigen::Vector3d& point : tin->points) {
      visit(Eigen::Vector2d((tin->origin + point).head<2>()));
    }
    return;
  }
  const auto& map = std::get<HeightMap>(design.shape);
  for_each_cell(map.z, [&](Cell at) {
    if (!std::isnan(map.z(at.row, at.col))) {
      visit(Eigen::Vector2d(map.x(at.col), map.y(at.row)));
    }
  });
}

/// Twice the way from the middle to the farthest place.
double diagonal_of(const DesignSurface& design) {
  const Rectangle all = extent_of(design);
  const Eigen::Vector2d middle(0.5 * (all.x_min + all.x_max), 0.5 * (all.y_min + all.y_max));
  double farthest = 0.0;
  for_each_place(design, [&](const Eigen::Vector2d& place) {
    farthest = std::max(farthest, (place - middle).norm());
  });
  return 2.0 * farthest;
}

/// Of the rectangle of an area and a diagonal [m]; of the square, if there is none.
double longer_side(double area, double diagonal) {
  const double sum = std::sqrt(diagonal * diagonal + 2.0 * area);
  const double difference = std::sqrt(std::max(0.0, diagonal * diagonal - 2.0 * area));
  return difference > 0.0 ? 0.5 * (sum + difference) : std::sqrt(area);
}

}  // namespace

JobShape shape_of(const DesignSurface& design, const CutAndFill& cut) {
  require(cut.cut.value > 0.0, "estimate: nothing of the design lies below the ground");
  const Faces faces = std::visit([](const auto& shape) { return faces_of(shape); }, design.shape);
  JobShape shape;
  shape.volume = cut.cut;
  shape.length = longer_side(faces.area, diagonal_of(design));
  shape.width = faces.area / shape.length;
  shape.depth = cut.cut.value / faces.area;
  shape.steep_share = faces.steep / faces.area;
  return shape;
}

JobShape shape_on_level_ground(DesignWords words) {
  constexpr double cells_along = 2000.0;
  words.from = {0.0, 0.0};
  words.heading = 0.0;
  require(words.depth.has_value(), "estimate: a design on level ground needs a depth");
  const double rise = words.length * std::abs(words.grade);
  const double aside = words.floor_width + (*words.depth + rise) * words.batter + 1.0;
  const Rectangle extent = {-aside, -aside, words.length + aside, aside};
  const double cell = std::max(0.05, (extent.x_max - extent.x_min) / cells_along);
  const HeightMap ground = flat_ground(extent, cell);
  const DesignSurface design = design_of_words(words, ground);
  return shape_of(design, cut_and_fill(design, ground));
}

}  // namespace excavplan
