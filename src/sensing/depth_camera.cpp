// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/sensing/depth_camera.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include "base/random.hpp"

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "ground/map_check.hpp"
#include "sensing/ray_target.hpp"

namespace excavplan {
namespace {

constexpr double edge_share = 0.02;  // ours: neighbours that differ by more lie across an edge [-]

// Ours: beyond them no sensor is.
constexpr double largest_error = 1e3;  // [m], [1/m]
constexpr double farthest = 1e9;       // from the origin [m]

// Streams of a scan beyond those of its rows, which are 0 .. 9999.
constexpr std::uint64_t pattern_stream = 1000000;
constexpr std::uint64_t edge_stream = 2000000;

void require_share(const std::string& what, double value) {
  require(value >= 0.0 && value < 1.0, what, value, "in 0 .. 1");
}

void require_count(const std::string& what, int value) {
  require(value > 0 && value <= 10000, what, value, "in 1 .. 10000");
}

void require_range(const std::string& what, double value) {
  require(value > 0.0 && value <= longest_range, what, value,
          "above 0 and at most " + number_text(longest_range) + " m");
}

void require_place(const std::string& what, const Eigen::Vector3d& place) {
  for (const double number : place) require_in(what + " [m]", number, -farthest, farthest);
}

void check(const DepthCamera& camera) {
  const std::string of = "depth camera: ";
  require_count(of + "width", camera.width);
  require_count(of + "height", camera.height);
  require_count(of + "frames", camera.frames);
  constexpr double most_depths = 1e9;  // ours
  require_in(of + "pixels of all frames", 1.0 * camera.width * camera.height * camera.frames, 1.0,
             most_depths);
  require(camera.horizontal_view > 0.0 && camera.horizontal_view < 3.0, of + "horizontal view",
          camera.horizontal_view, "in 0 .. 3 rad");
  require_place(of + "place", camera.position);
  require_place(of + "target", camera.target);
  require_in(of + "noise [m]", camera.noise, 0.0, largest_error);
  require_share(of + "dropouts", camera.dropouts);
  require_range(of + "range", camera.max_range);
  require_in(of + "pattern noise [m]", camera.pattern_noise, 0.0, largest_error);
  require(camera.pattern_length >= 0.0 && camera.pattern_length <= 1000.0, of + "pattern length",
          camera.pattern_length, "in 0 .. 1000 pixels");
  require_in(of + "disparity step [1/m]", camera.disparity_step, 0.0, largest_error);
  require(camera.flying_pixels >= 0.0 && camera.flying_pixels <= 1.0, of + "flying pixels",
          camera.flying_pixels, "in 0 .. 1");
  const double distance = (camera.target - camera.position).norm();
  require(distance > 1e-6, of + "distance from position to target", distance, "> 0 m");
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

/// The image plane of a camera: one ray (right, down, 1) per pixel.
class ImagePlane {
 public:
  explicit ImagePlane(const DepthCamera& camera)
      : width_(camera.width),
        height_(camera.height),
        focal_(0.5 * camera.width / std::tan(0.5 * camera.horizontal_view)) {}
  Eigen::Vector3d pixel(Eigen::Index v, Eigen::Index u) const {
    return {(static_cast<double>(u) + 0.5 - 0.5 * width_) / focal_,
            (static_cast<double>(v) + 0.5 - 0.5 * height_) / focal_, 1.0};
  }

 private:
  int width_;
  int height_;
  double focal_;
};

/// True depth of every pixel (row, column of the image) [m], NaN where nothing is met.
Eigen::ArrayXXd depths(const HeightMap& surface, const DepthCamera& camera,
                       const Eigen::Matrix3d& axes) {
  const ImagePlane plane(camera);
  const RayTarget target(surface);
  Eigen::ArrayXXd depth(camera.height, camera.width);
  for (Eigen::Index u = 0; u < depth.cols(); ++u) {
    for (Eigen::Index v = 0; v < depth.rows(); ++v) {
      const Eigen::Vector3d pixel = plane.pixel(v, u);
      depth(v, u) = target.distance(camera.position, axes * pixel.normalized(), camera.max_range) /
                    pixel.norm();
    }
  }
  return depth;
}

/// Moves pixels at a step of depth somewhere between both sides of it.
void let_pixels_fly(Eigen::ArrayXXd& depth, double share, std::uint64_t seed) {
  const Eigen::ArrayXXd truth = depth;
  for (Eigen::Index v = 0; v < depth.rows(); ++v) {
    Random random(seed, edge_stream + static_cast<std::uint64_t>(v));
    for (Eigen::Index u = 0; u < depth.cols(); ++u) {
      const bool flies = random.uniform() < share;
      const double way = random.uniform();
      double across = truth(v, u);
      for (const auto& [dv, du] : {std::array{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
        const Eigen::Index row = v + dv;
        const Eigen::Index col = u + du;
        if (row < 0 || col < 0 || row >= depth.rows() || col >= depth.cols()) continue;
        const double other = truth(row, col);
        if (std::abs(other - truth(v, u)) > std::abs(across - truth(v, u))) across = other;
      }
      const bool at_edge = std::abs(across - truth(v, u)) > edge_share * truth(v, u);
      if (flies && at_edge) depth(v, u) += way * (across - truth(v, u));
    }
  }
}

/// Normal deviates of variance 1 whose covariance falls as exp(-d^2 / (2 pattern_length^2)).
Eigen::ArrayXXd smooth_noise(Eigen::Index rows, Eigen::Index cols, const DepthCamera& camera,
                             std::uint64_t seed) {
  const double length = camera.pattern_length;
  const auto reach = static_cast<Eigen::Index>(std::ceil(2.2 * length));
  Eigen::ArrayXXd white(rows + 2 * reach, cols + 2 * reach);
  for (Eigen::Index row = 0; row < white.rows(); ++row) {
    Random random(seed, pattern_stream + static_cast<std::uint64_t>(row));
    for (Eigen::Index col = 0; col < white.cols(); ++col) white(row, col) = random.normal();
  }
  if (reach == 0) return white;
  Eigen::ArrayXd weight(2 * reach + 1);
  for (Eigen::Index i = -reach; i <= reach; ++i) {
    weight(i + reach) = std::exp(-std::pow(static_cast<double>(i) / length, 2));
  }
  weight /= std::sqrt(weight.square().sum());
  Eigen::ArrayXXd along = Eigen::ArrayXXd::Zero(rows, white.cols());
  for (Eigen::Index i = 0; i < weight.size(); ++i) along += weight(i) * white.middleRows(i, rows);
  Eigen::ArrayXXd both = Eigen::ArrayXXd::Zero(rows, cols);
  for (Eigen::Index i = 0; i < weight.size(); ++i) both += weight(i) * along.middleCols(i, cols);
  return both;
}

double in_steps(double depth, double disparity_step) {
  if (!(disparity_step > 0.0) || std::isnan(depth)) return depth;
  return 1.0 / (disparity_step * std::max(1.0, std::round(1.0 / (depth * disparity_step))));
}

/// Depths as the camera gives them after averaging its frames; NaN where most frames have none.
Eigen::ArrayXXd measured(Eigen::ArrayXXd depth, const DepthCamera& camera, std::uint64_t seed) {
  if (camera.flying_pixels > 0.0) let_pixels_fly(depth, camera.flying_pixels, seed);
  Eigen::ArrayXXd pattern = Eigen::ArrayXXd::Zero(depth.rows(), depth.cols());
  if (camera.pattern_noise > 0.0) {
    pattern = camera.pattern_noise * smooth_noise(depth.rows(), depth.cols(), camera, seed);
  }
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(depth.rows(), depth.cols());
  Eigen::ArrayXXi count = Eigen::ArrayXXi::Zero(depth.rows(), depth.cols());
  for (int frame = 0; frame < camera.frames; ++frame) {
    for (Eigen::Index v = 0; v < depth.rows(); ++v) {
      Random random(seed, static_cast<std::uint64_t>(v), static_cast<std::uint64_t>(frame));
      for (Eigen::Index u = 0; u < depth.cols(); ++u) {
        const bool dropped = random.uniform() < camera.dropouts;
        const double noise = random.normal();
        if (dropped) continue;
        const double z = depth(v, u);
        sum(v, u) += in_steps(z + camera.noise * z * z * noise + pattern(v, u) * z * z,
                              camera.disparity_step);
        ++count(v, u);
      }
    }
  }
  return (2 * count >= camera.frames).select(sum / count.cast<double>(), nan);
}

void check(const Lidar& lidar) {
  const std::string of = "lidar: ";
  for (const auto* window : {&lidar.azimuth, &lidar.elevation}) {
    const double width = (*window)(1) - (*window)(0);
    require(width >= 0.0, of + "width of a window", width, ">= 0 rad");
    require(width <= 2.0 * pi, of + "width of a window", width, "at most 2 pi rad");
    require_in(of + "first angle of a window [rad]", (*window)(0), -2.0 * pi, 2.0 * pi);
  }
  require(lidar.angle_step.minCoeff() > 0.0, of + "angle step", lidar.angle_step.minCoeff(),
          "> 0 rad");
  require_place(of + "place", lidar.position);
  require_in(of + "range noise [m]", lidar.range_noise, 0.0, largest_error);
  require(lidar.divergence >= 0.0 && lidar.divergence < 0.5, of + "divergence", lidar.divergence,
          "in 0 .. 0.5 rad");
  require_in(of + "pulse length [m]", lidar.pulse_length, 0.0, longest_range);
  require_share(of + "dropouts", lidar.dropouts);
  require_range(of + "range", lidar.max_range);
  const double beams = (1.0 + (lidar.azimuth(1) - lidar.azimuth(0)) / lidar.angle_step(0)) *
                       (1.0 + (lidar.elevation(1) - lidar.elevation(0)) / lidar.angle_step(1));
  require(beams <= 1e8, of + "number of beams", beams, "at most 100 million");
}

struct Beam {
  Eigen::Vector3d direction;
  Eigen::Vector3d left;  ///< both at right angles to the direction
  Eigen::Vector3d up;
};

Beam beam_at(double azimuth, double elevation) {
  const Eigen::Vector3d left(-std::sin(azimuth), std::cos(azimuth), 0.0);
  const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  return {direction, left, direction.cross(left)};
}

// Quadrature of a disc: six points at sqrt(2/3) of the radius and its centre.
constexpr int ring = 6;
constexpr double centre_weight = 0.25;
constexpr double ring_weight = 0.125;

/// How far its rays lie to the left of and above the middle of a beam, at a distance of 1.
std::array<Eigen::Vector2d, ring + 1> rays_of_beam(double divergence) {
  constexpr double turn = 2.0 * pi;
  const double radius = std::sqrt(2.0 / 3.0) * std::tan(0.5 * divergence);
  std::array<Eigen::Vector2d, ring + 1> rays;
  for (int i = 0; i <= ring; ++i) {
    const double angle = turn * i / ring;
    const double off = i == ring ? 0.0 : radius;
    rays[static_cast<std::size_t>(i)] = {off * std::cos(angle), off * std::sin(angle)};
  }
  return rays;
}

/// Range that a beam returns without noise; NaN if nothing is met.
double mixed_range(const RayTarget& target, const Lidar& lidar, const Beam& beam,
                   const std::array<Eigen::Vector2d, ring + 1>& rays) {
  std::array<double, ring + 1> range{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d ray = beam.direction + rays[i].x() * beam.left + rays[i].y() * beam.up;
    range[i] = target.distance(lidar.position, ray.normalized(), lidar.max_range);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const double r : range) nearest = r < nearest ? r : nearest;
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < range.size(); ++i) {
    if (!(range[i] <= nearest + lidar.pulse_length)) continue;
    const double weight = i == ring ? centre_weight : ring_weight;
    sum += weight * range[i];
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : nan;
}

Eigen::Index steps(const Eigen::Vector2d& window, double step) {
  return 1 + static_cast<Eigen::Index>(std::floor((window(1) - window(0)) / step + 1e-9));
}

}  // namespace

DepthCamera camera_above(const Eigen::Vector2d& ground_point, double ground_z) {
  DepthCamera camera;
  camera.position = {ground_point.x(), ground_point.y() - 0.3, ground_z + 2.8};
  camera.target = {ground_point.x(), ground_point.y(), ground_z};
  return camera;
}

DepthCamera with_errors_of(const Sensor& sensor, DepthCamera camera) {
  require(sensor.width > 0, "image of the sensor '" + sensor.name + "'", sensor.width,
          "1 pixel wide or more: scans of others are simulated by a lidar");
  camera.width = sensor.width;
  camera.height = sensor.height;
  camera.noise = sensor.noise;
  camera.pattern_noise = sensor.pattern;
  camera.pattern_length = sensor.pattern_rays;
  camera.disparity_step = sensor.disparity_step;
  camera.flying_pixels = sensor.flying_pixels;
  return camera;
}

std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const DepthCamera& camera,
                                          std::uint64_t seed) {
  check(camera);
  require_map(surface, "scan: surface");
  const Eigen::Matrix3d axes = site_from_camera(camera);
  const ImagePlane plane(camera);
  const Eigen::ArrayXXd depth = measured(depths(surface, camera, axes), camera, seed);
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(depth.size()));
  for (Eigen::Index v = 0; v < depth.rows(); ++v) {
    for (Eigen::Index u = 0; u < depth.cols(); ++u) {
      if (std::isnan(depth(v, u))) continue;
      points.emplace_back(camera.position + depth(v, u) * (axes * plane.pixel(v, u)));
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> scan_surface(const HeightMap& surface, const Lidar& lidar,
                                          std::uint64_t seed) {
  check(lidar);
  require_map(surface, "scan: surface");
  const RayTarget target(surface);
  const auto rays = rays_of_beam(lidar.divergence);
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index row = 0; row < steps(lidar.elevation, lidar.angle_step(1)); ++row) {
    Random random(seed, static_cast<std::uint64_t>(row));
    const double elevation = lidar.elevation(0) + static_cast<double>(row) * lidar.angle_step(1);
    for (Eigen::Index col = 0; col < steps(lidar.azimuth, lidar.angle_step(0)); ++col) {
      const double azimuth = lidar.azimuth(0) + static_cast<double>(col) * lidar.angle_step(0);
      const bool dropped = random.uniform() < lidar.dropouts;
      const double noise = random.normal();
      if (dropped) continue;
      const Beam beam = beam_at(azimuth, elevation);
      const double range = mixed_range(target, lidar, beam, rays);
      if (std::isnan(range)) continue;
      points.emplace_back(lidar.position + (range + lidar.range_noise * noise) * beam.direction);
    }
  }
  return points;
}

}  // namespace excavplan
