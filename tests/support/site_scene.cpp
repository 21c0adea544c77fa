// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/site_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace excavplan::scenes {

HeightMap surface_of(const SiteScene& scene, bool after) {
  HeightMap map = flat_ground(scene.extent, 0.02);
  const double quarter = 0.25 * map.cell_size;
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      double sum = 0.0;
      for (const double dx : {-quarter, quarter}) {
        for (const double dy : {-quarter, quarter}) {
          const double x = map.x(col) + dx;
          const double y = map.y(row) + dy;
          sum += after ? scene.after(x, y) : scene.before(x, y);
        }
      }
      map.z(row, col) = 0.25 * sum;
    }
  }
  return map;
}

Eigen::Vector3d face_point(const SiteScene& scene, bool after, Random& random) {
  const Box& wall = scene.walls.front();
  const double u = random.uniform(-0.5, 0.5) * wall.length;
  const double v = 0.5 * wall.width;
  const double x = wall.x + u * std::cos(wall.heading) - v * std::sin(wall.heading);
  const double y = wall.y + u * std::sin(wall.heading) + v * std::cos(wall.heading);
  const double foot = after ? scene.after(x, y) : scene.before(x, y);
  return {x, y, random.uniform(std::min(foot, wall.top), wall.top)};
}

Eigen::Vector2d place_of(const SiteScene& scene, std::size_t index, Random& random) {
  const Rectangle& extent = scene.extent;
  const double spacing = scene.sampling.lattice;
  if (spacing == 0.0) {
    const double x = random.uniform(extent.x_min, extent.x_max);
    return {x, random.uniform(extent.y_min, extent.y_max)};
  }
  const auto across = static_cast<std::size_t>((extent.x_max - extent.x_min) / spacing);
  return {extent.x_min + spacing * (static_cast<double>(index % across) + 0.5),
          extent.y_min + spacing * (static_cast<double>(index / across) + 0.5)};
}

std::size_t points_of(const SiteScene& scene) {
  const double spacing = scene.sampling.lattice;
  if (spacing == 0.0) return scene.sampling.points;
  const auto nodes = [&](double span) { return static_cast<std::size_t>(span / spacing); };
  return nodes(scene.extent.x_max - scene.extent.x_min) *
         nodes(scene.extent.y_max - scene.extent.y_min);
}

Points even_scan(const SiteScene& scene, bool after, std::uint64_t seed) {
  const Sampling& sampling = scene.sampling;
  Random random(seed, after ? 12 : 11);
  const double heading = random.uniform(0.0, pi);
  Points cloud;
  cloud.reserve(points_of(scene));
  for (std::size_t i = 0; i < points_of(scene); ++i) {
    const bool on_face = sampling.face_share > 0.0 && random.uniform() < sampling.face_share;
    const Eigen::Vector2d at = place_of(scene, i, random);
    const double x = at.x();
    const double y = at.y();
    Eigen::Vector3d point(x, y, after ? scene.after(x, y) : scene.before(x, y));
    if (on_face) point = face_point(scene, after, random);
    if (sampling.grass_share > 0.0 && !(after && scene.bare(x, y)) &&
        random.uniform() < sampling.grass_share) {
      point.z() += random.uniform(0.0, sampling.grass_height);
    }
    if (sampling.stripe_error > 0.0) {
      const double line = x * std::cos(heading) + y * std::sin(heading);
      const auto number = std::llround(line / sampling.stripe_width) + 100000;
      Random of_line(seed, after ? 22 : 21, static_cast<std::uint64_t>(number));
      point.z() += sampling.stripe_error * of_line.normal();
    }
    const double dx = random.normal();
    const double dy = random.normal();
    cloud.push_back(point + sampling.noise * Eigen::Vector3d(dx, dy, random.normal()));
  }
  return cloud;
}

void spoil(const SiteScene& scene, bool after, std::uint64_t seed, Points& points) {
  constexpr double reach = 0.3;  // of a beam's foot [m]
  const Sampling& sampling = scene.sampling;
  Random random(seed, after ? 32 : 31);
  const auto height = [&](double x, double y) {
    return after ? scene.after(x, y) : scene.before(x, y);
  };
  for (Eigen::Vector3d& point : points) {
    const double kind = random.uniform();
    const double share = random.uniform();
    if (kind < sampling.outliers) {
      point.z() += random.uniform(-0.3, 1.0);
    } else if (kind < sampling.outliers + sampling.flying) {
      const Eigen::Vector2d other(point.x() + random.uniform(-reach, reach),
                                  point.y() + random.uniform(-reach, reach));
      const Eigen::Vector3d beside(other.x(), other.y(), height(other.x(), other.y()));
      point += share * (beside - point);
    } else if (kind > 1.0 - sampling.multipath) {
      const bool is_in_hole = after && scene.moved(point.x(), point.y()) < 0.0;
      if (is_in_hole) point.z() -= random.uniform(0.05, 0.4);
    } else if (kind > 1.0 - sampling.multipath - sampling.no_data) {
      point.z() = sampling.no_data_height;
    }
  }
}

void thin(Points& points, double edge) {
  std::set<std::array<long long, 3>> taken;
  const auto is_later = [&](const Eigen::Vector3d& p) {
    const auto number = [&](int axis) { return std::llround(p(axis) / edge); };
    return !taken.insert({number(0), number(1), number(2)}).second;
  };
  points.erase(std::remove_if(points.begin(), points.end(), is_later), points.end());
}

std::vector<Points> scanned(const SiteScene& scene, bool after, std::uint64_t seed) {
  const auto& lidars = after ? scene.sampling.lidars_after : scene.sampling.lidars_before;
  if (lidars.empty()) {
    std::vector<Points> clouds = {even_scan(scene, after, seed)};
    spoil(scene, after, seed, clouds.front());
    return clouds;
  }
  const HeightMap surface = surface_of(scene, after);
  std::vector<Points> clouds;
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    clouds.push_back(scan_surface(surface, lidars[i], seed * 8 + (after ? 4 : 0) + i));
    spoil(scene, after, seed * 8 + i, clouds.back());
    if (scene.sampling.voxel > 0.0) thin(clouds.back(), scene.sampling.voxel);
  }
  return clouds;
}

Scan handed_over(const SiteScene& scene, bool after, std::uint64_t seed) {
  const auto& lidars = after ? scene.sampling.lidars_after : scene.sampling.lidars_before;
  const PointMap& frame = after ? scene.frame_after : scene.frame_before;
  Scan scan;
  for (Points& points : scanned(scene, after, seed)) {
    if (frame) std::transform(points.begin(), points.end(), points.begin(), frame);
    auto cloud = std::make_shared<Cloud>();
    if (const std::size_t i = scan.clouds.size(); i < lidars.size() && scene.sampling.places_told) {
      cloud->sensor_origin = frame ? frame(lidars[i].position) : lidars[i].position;
    }
    cloud->width = points.size();
    cloud->points = std::move(points);
    scan.clouds.push_back(std::move(cloud));
  }
  return scan;
}

DigScans scans_of(const SiteScene& scene, std::uint64_t seed) {
  DigScans scans{handed_over(scene, false, seed), handed_over(scene, true, seed)};
  if (scene.swapped) std::swap(scans.before, scans.after);
  if (scene.two_areas) {
    const double middle = 0.5 * (scene.dig.pit_x + scene.heap.x());
    scans.dump = ScanPair{scans.before, scans.after};
    Rectangle area = scene.extent;
    area.x_max = middle;
    scans.before.area = scans.after.area = area;
    area = scene.extent;
    area.x_min = middle;
    scans.dump->before.area = scans.dump->after.area = area;
  }
  return scans;
}

}  // namespace excavplan::scenes
