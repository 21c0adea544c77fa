// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/density/density_estimate.hpp>
#include <excavplan/sensing/depth_camera.hpp>

#include "support/site_shapes.hpp"

/// @file
/// One scene of a site: its surfaces, the soil that was really moved, how it is scanned, and its
/// scans as clouds in memory.

namespace excavplan::scenes {

/// The volumes that are true [m^3].
struct Volumes {
  double hole = 0.0;   ///< undisturbed volume of the soil that was dug
  double spill = 0.0;  ///< soil beside the hole
  double heap = 0.0;   ///< soil that was dumped or lost on the way
  double bulking() const { return (spill + heap) / hole; }
};

/// How a scene is scanned. Without lidars the points are even in plan.
struct Sampling {
  std::size_t points = 300000;       ///< in a cloud
  double noise = 0.005;              ///< of every coordinate [m]
  double lattice = 0.0;              ///< spacing of a regular lattice instead of random points [m]
  double stripe_error = 0.0;         ///< sd of the height of a scan line [m]
  double stripe_width = 0.03;        ///< [m]
  double grass_share = 0.0;          ///< share of the returns from grass
  double grass_height = 0.0;         ///< these spread evenly up to here [m]
  double face_share = 0.0;           ///< points on the near face of the wall, as a share of all
  std::vector<Lidar> lidars_before;  ///< one for each cloud
  bool places_told = true;           ///< the clouds say where their lidars stood
  double voxel = 0.0;                ///< edge of the cubes that are left one point each [m]
  std::vector<Lidar> lidars_after;
};

/// What is done to a cloud before it is handed over.
using PointMap = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

struct SiteScene {
  Rectangle extent = {-3.0, -3.0, 8.5, 3.0};
  Dig dig;                                    ///< its bulking fits the main heap alone
  Eigen::Vector2d heap = {dump_offset, 0.0};  ///< centre of the main heap
  Ground ground{ScanErrors{}, 1};
  Volumes truth;
  Height moved = flat;     ///< change by the soil of the dig
  Height other = flat;     ///< change that is none of the dig
  Height older = flat;     ///< on the ground, before the first scan
  double pressed = 0.0;    ///< the ground sank by this under the heap [m]
  double water = -1e9;     ///< level in the pit
  std::vector<Box> boxes;  ///< set down after the first scan
  std::vector<Box> walls;  ///< stood there before
  Sampling sampling;
  PointMap frame_before;  ///< none: the clouds are in the frame of the scene
  PointMap frame_after;
  bool swapped = false;      ///< the scan after is handed over as the one before
  bool two_areas = false;    ///< dig and dump are handed over as areas of their own
  bool offset_pair = false;  ///< to compare with the same scene without its frames

  double before(double x, double y) const { return with(walls, ground(x, y) + older(x, y), x, y); }
  double after(double x, double y) const {
    const double soil = moved(x, y);
    const double beside = other(x, y);
    double change = soil;
    if (soil == 0.0 || (soil * beside > 0.0 && std::abs(beside) > std::abs(soil))) change = beside;
    if (pressed > 0.0 && soil > 0.0 && x > 0.5 * heap.x()) change -= std::min(pressed, 0.2 * soil);
    double z = ground(x, y) + older(x, y) + change;
    if (soil < 0.0) z = std::max(z, water);
    return with(walls, with(boxes, z, x, y), x, y);
  }
  /// Whether grass does not stand there after the dig.
  bool bare(double x, double y) const { return moved(x, y) != 0.0; }

 private:
  static double with(const std::vector<Box>& boxes, double z, double x, double y) {
    for (const Box& box : boxes) {
      if (box.holds(x, y)) z = std::max(z, box.top);
    }
    return z;
  }
};

/// The scene on cells of 2 cm, each the mean of four heights.
inline HeightMap surface_of(const SiteScene& scene, bool after) {
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

/// Points of the near face of a wall above what lies at its foot.
inline Eigen::Vector3d face_point(const SiteScene& scene, bool after, Random& random) {
  const Box& wall = scene.walls.front();
  const double u = random.uniform(-0.5, 0.5) * wall.length;
  const double v = 0.5 * wall.width;
  const double x = wall.x + u * std::cos(wall.heading) - v * std::sin(wall.heading);
  const double y = wall.y + u * std::sin(wall.heading) + v * std::cos(wall.heading);
  const double foot = after ? scene.after(x, y) : scene.before(x, y);
  return {x, y, random.uniform(std::min(foot, wall.top), wall.top)};
}

/// One point of an even scan; `index` counts the nodes of a lattice.
inline Eigen::Vector2d place_of(const SiteScene& scene, std::size_t index, Random& random) {
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

inline std::size_t points_of(const SiteScene& scene) {
  const double spacing = scene.sampling.lattice;
  if (spacing == 0.0) return scene.sampling.points;
  const auto nodes = [&](double span) { return static_cast<std::size_t>(span / spacing); };
  return nodes(scene.extent.x_max - scene.extent.x_min) *
         nodes(scene.extent.y_max - scene.extent.y_min);
}

inline Points even_scan(const SiteScene& scene, bool after, std::uint64_t seed) {
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

/// Leaves the first point in each cube.
inline void thin(Points& points, double edge) {
  std::set<std::array<long long, 3>> taken;
  const auto is_later = [&](const Eigen::Vector3d& p) {
    const auto number = [&](int axis) { return std::llround(p(axis) / edge); };
    return !taken.insert({number(0), number(1), number(2)}).second;
  };
  points.erase(std::remove_if(points.begin(), points.end(), is_later), points.end());
}

/// The clouds of one scan, in the frame of the scene.
inline std::vector<Points> scanned(const SiteScene& scene, bool after, std::uint64_t seed) {
  const auto& lidars = after ? scene.sampling.lidars_after : scene.sampling.lidars_before;
  if (lidars.empty()) return {even_scan(scene, after, seed)};
  const HeightMap surface = surface_of(scene, after);
  std::vector<Points> clouds;
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    clouds.push_back(scan_surface(surface, lidars[i], seed * 8 + (after ? 4 : 0) + i));
    if (scene.sampling.voxel > 0.0) thin(clouds.back(), scene.sampling.voxel);
  }
  return clouds;
}

/// The clouds of one scan, each of which says where its lidar stood.
inline Scan handed_over(const SiteScene& scene, bool after, std::uint64_t seed) {
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

/// The scans of a scene as estimate_density() takes them.
inline DigScans scans_of(const SiteScene& scene, std::uint64_t seed) {
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
