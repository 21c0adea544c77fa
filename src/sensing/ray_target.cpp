// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "sensing/ray_target.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"

namespace excavplan {
namespace {

constexpr Eigen::Index tile = 2;   // cells: of 2, 4, 8, 16 and 32 the fastest
constexpr double lowest = -1e300;  // [m]
constexpr double rounding = 1e-6;  // cells: a mean of heights may lie above them by less

}  // namespace

RayTarget::RayTarget(const HeightMap& surface)
    : surface_(surface), tiles_per_metre_(1.0 / (static_cast<double>(tile) * surface.cell_size)) {
  const Eigen::Index rows = surface.z.rows(), cols = surface.z.cols();
  tile_top_.resize((rows + tile - 1) / tile, (cols + tile - 1) / tile);
  for (Eigen::Index c = 0; c < tile_top_.cols(); ++c) {
    for (Eigen::Index r = 0; r < tile_top_.rows(); ++r) {
      // A height between centres is of cells up to one beyond the tile.
      const Eigen::Index row = std::max<Eigen::Index>(0, r * tile - 1);
      const Eigen::Index col = std::max<Eigen::Index>(0, c * tile - 1);
      const auto known = surface.z.block(row, col, std::min(rows, (r + 1) * tile + 1) - row,
                                         std::min(cols, (c + 1) * tile + 1) - col);
      tile_top_(r, c) = known.isNaN().select(lowest, known).maxCoeff();
    }
  }
  top_ = tile_top_.size() > 0 ? tile_top_.maxCoeff() : lowest;
  tile_top_ += rounding * surface.cell_size;
}

double RayTarget::distance(const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                           double range) const {
  if (!(ray.z() < 0.0)) return nan;
  // Nothing can be met before the ray is down at the highest point of the ground.
  const double skipped = std::max(0.0, (top_ + surface_.cell_size - from.z()) / ray.z());
  const double left = std::min(range - skipped, way_over(from + skipped * ray, ray));
  return skipped + march(from + skipped * ray, ray, left);
}

double RayTarget::march(const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                        double range) const {
  const double step = 0.5 * surface_.cell_size;
  double last = 0.0;
  for (double distance = 0.0; distance <= range; distance += step) {
    const Eigen::Vector3d point = from + distance * ray;
    if (!is_over_tile(point)) {
      const double now = above(point);
      if (now <= 0.0) {
        const double before = distance > 0.0 ? above(from + last * ray) : nan;
        if (!(before > 0.0)) return nan;  // unknown ground hides where it was met
        return last + (distance - last) * before / (before - now);
      }
    }
    last = distance;
  }
  return nan;
}

/// How far along a ray the map lies, with a cell to spare: it is never met again behind its border.
double RayTarget::way_over(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
  const Rectangle map = surface_.extent();
  const double x = (ray.x() > 0.0 ? map.x_max : map.x_min) - from.x();
  const double y = (ray.y() > 0.0 ? map.y_max : map.y_min) - from.y();
  constexpr double upright = 1e-12;  // leaves the map on no axis
  const double along_x = std::abs(ray.x()) > upright ? x / ray.x() : longest_range;
  const double along_y = std::abs(ray.y()) > upright ? y / ray.y() : longest_range;
  const double slant = std::max(std::hypot(ray.x(), ray.y()), upright);
  return std::min(along_x, along_y) + surface_.cell_size / slant;
}

double RayTarget::above(const Eigen::Vector3d& point) const {
  return point.z() - height_at(surface_, point.x(), point.y());
}

/// Whether all known ground about a point is lower. False beside the map.
bool RayTarget::is_over_tile(const Eigen::Vector3d& point) const {
  const double u = (point.x() - surface_.origin.x()) * tiles_per_metre_;
  const double v = (point.y() - surface_.origin.y()) * tiles_per_metre_;
  if (!(u >= 0.0 && v >= 0.0)) return false;
  const auto col = static_cast<Eigen::Index>(u), row = static_cast<Eigen::Index>(v);
  return col < tile_top_.cols() && row < tile_top_.rows() && point.z() > tile_top_(row, col);
}

}  // namespace excavplan
