// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
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
  double outliers = 0.0;             ///< share of points off by -0.3 .. 1 m in height
  double flying = 0.0;               ///< share of points between the ground at two near places
  double multipath = 0.0;            ///< share of points in the hole 0.05 .. 0.4 m too deep
  double no_data = 0.0;              ///< share of points at a height that means "none"
  double no_data_height = -9999.0;   ///< that height [m]
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
  Height moved = flat;            ///< change by the soil of the dig
  Height other = flat;            ///< change that is none of the dig
  Height older = flat;            ///< on the ground, before the first scan
  double pressed = 0.0;           ///< the ground sank by this under the heap [m]
  double water = -1e9;            ///< level in the pit
  std::vector<Box> boxes;         ///< set down after the first scan
  std::vector<Box> walls;         ///< stood there before
  std::vector<Box> boxes_before;  ///< stood there before and were taken away
  double floor = -1e9;            ///< level of the floor of the pit, where it lies above the pit
  Sampling sampling;
  PointMap frame_before;  ///< none: the clouds are in the frame of the scene
  PointMap frame_after;
  bool swapped = false;      ///< the scan after is handed over as the one before
  bool two_areas = false;    ///< dig and dump are handed over as areas of their own
  bool offset_pair = false;  ///< to compare with the same scene without its frames

  double before(double x, double y) const {
    return with(walls, with(boxes_before, ground(x, y) + older(x, y), x, y), x, y);
  }
  double after(double x, double y) const {
    const double soil = moved(x, y);
    const double beside = other(x, y);
    double change = soil;
    if (soil == 0.0 || (soil * beside > 0.0 && std::abs(beside) > std::abs(soil))) change = beside;
    if (pressed > 0.0 && soil > 0.0 && x > 0.5 * heap.x()) change -= std::min(pressed, 0.2 * soil);
    double z = ground(x, y) + older(x, y) + change;
    if (soil < 0.0) z = std::max({z, water, floor});
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
HeightMap surface_of(const SiteScene& scene, bool after);

/// Points of the near face of a wall above what lies at its foot.
Eigen::Vector3d face_point(const SiteScene& scene, bool after, Random& random);

/// One point of an even scan; `index` counts the nodes of a lattice.
Eigen::Vector2d place_of(const SiteScene& scene, std::size_t index, Random& random);

std::size_t points_of(const SiteScene& scene);

/// Adds outliers, flying points and values that mean "none" to a scan.
void spoil(const SiteScene& scene, bool after, std::uint64_t seed, Points& points);

Points even_scan(const SiteScene& scene, bool after, std::uint64_t seed);

/// Leaves the first point in each cube.
void thin(Points& points, double edge);

/// The clouds of one scan, in the frame of the scene.
std::vector<Points> scanned(const SiteScene& scene, bool after, std::uint64_t seed);

/// The clouds of one scan, each of which says where its lidar stood.
Scan handed_over(const SiteScene& scene, bool after, std::uint64_t seed);

/// The scans of a scene as estimate_density() takes them.
DigScans scans_of(const SiteScene& scene, std::uint64_t seed);

}  // namespace excavplan::scenes
