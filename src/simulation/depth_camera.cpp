// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/depth_camera.hpp>

#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include <excavplan/error.hpp>
#include <excavplan/random.hpp>

namespace excavplan {
namespace {

void check(const DepthCamera& camera) {
  const auto require = [](bool holds, const char* rule, double value) {
    if (!holds) {
      throw Error(ErrorKind::bad_input,
                  std::string("depth camera: ") + rule + ", got " + std::to_string(value));
    }
  };
  require(camera.width > 0 && camera.width <= 10000, "width must be in 1 .. 10000", camera.width);
  require(camera.height > 0 && camera.height <= 10000, "height must be in 1 .. 10000",
          camera.height);
  require(camera.horizontal_view > 0.0 && camera.horizontal_view < 3.0,
          "horizontal view must be in 0 .. 3 rad", camera.horizontal_view);
  require(camera.noise >= 0.0, "noise must be >= 0 m", camera.noise);
  require(camera.dropouts >= 0.0 && camera.dropouts < 1.0, "dropouts must be in 0 .. 1",
          camera.dropouts);
  require(camera.max_range > 0.0, "range must be > 0 m", camera.max_range);
  require((camera.target - camera.position).norm() > 1e-6,
          "distance from position to target must be > 0 m",
          (camera.target - camera.position).norm());
}

/// Columns: right, down, forward in the site frame. A camera that looks straight down has the
/// site's -y to its right.
Eigen::Matrix3d site_from_camera(const DepthCamera& camera) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-6) right = -Eigen::Vector3d::UnitY();
  right.normalize();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return axes;
}

/// Distance along the ray at which it first meets the surface; NaN if it does not.
double hit(const HeightMap& surface, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
           double range) {
  const double step = 0.5 * surface.cell;
  double last = std::nan("");
  double last_distance = 0.0;
  for (double distance = 0.0; distance <= range; distance += step) {
    const Eigen::Vector3d point = from + distance * ray;
    const double above = point.z() - height_at(surface, point.x(), point.y());
    if (above <= 0.0) {
      if (!(last > 0.0)) return std::nan("");  // unknown ground hides where it was met
      return last_distance + (distance - last_distance) * last / (last - above);
    }
    last = above;
    last_distance = distance;
  }
  return std::nan("");
}

}  // namespace

DepthCamera camera_above(const Eigen::Vector2d& ground_point, double ground_z) {
  DepthCamera camera;
  camera.position = {ground_point.x(), ground_point.y() - 0.3, ground_z + 2.8};
  camera.target = {ground_point.x(), ground_point.y(), ground_z};
  return camera;
}

std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const DepthCamera& camera,
                                          std::uint64_t seed) {
  check(camera);
  const Eigen::Matrix3d axes = site_from_camera(camera);
  const double focal = 0.5 * camera.width / std::tan(0.5 * camera.horizontal_view);
  const double highest = surface.z.isNaN().select(-1e300, surface.z).maxCoeff();
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int v = 0; v < camera.height; ++v) {
    Random random(seed, static_cast<std::uint64_t>(v));
    for (int u = 0; u < camera.width; ++u) {
      const bool dropped = random.uniform() < camera.dropouts;
      const double noise = random.normal();
      const Eigen::Vector3d pixel((u + 0.5 - 0.5 * camera.width) / focal,
                                  (v + 0.5 - 0.5 * camera.height) / focal, 1.0);
      const Eigen::Vector3d ray = axes * pixel.normalized();
      if (dropped || !(ray.z() < 0.0)) continue;
      // Nothing can be met before the ray is down at the highest point of the ground.
      const double skipped =
          std::max(0.0, (highest + surface.cell - camera.position.z()) / ray.z());
      const double distance =
          skipped + hit(surface, camera.position + skipped * ray, ray, camera.max_range - skipped);
      if (std::isnan(distance)) continue;
      const double depth = distance / pixel.norm();
      const double measured = depth + camera.noise * depth * depth * noise;
      points.push_back(camera.position + measured * (axes * pixel));
    }
  }
  return points;
}

}  // namespace excavplan
