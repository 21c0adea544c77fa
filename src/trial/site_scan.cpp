// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/site_scan.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "trial/plan_polygon.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Streams of a scan.
constexpr std::uint64_t registration_stream = 1;
constexpr std::uint64_t pattern_stream = 2;
constexpr std::uint64_t look_stream = 3;

/// Normal deviates of variance 1 over the ground, alike over pattern_length.
class Pattern {
 public:
  Pattern(const Rectangle& area, std::uint64_t seed)
      : field_(flat_ground(area, spacing * pattern_length)) {
    // A kernel exp(-d^2 / length^2) on white noise gives covariance exp(-d^2 / (2 length^2)).
    const auto reach = static_cast<Index>(std::ceil(2.2 / spacing));
    const Index rows = field_.z.rows(), cols = field_.z.cols();
    ArrayXXd white(rows + 2 * reach, cols + 2 * reach);
    for (Index col = 0; col < white.cols(); ++col) {
      Random random(seed, pattern_stream, static_cast<std::uint64_t>(col));
      for (Index row = 0; row < white.rows(); ++row) white(row, col) = random.normal();
    }
    Eigen::ArrayXd weight(2 * reach + 1);
    for (Index i = -reach; i <= reach; ++i) {
      weight(i + reach) = std::exp(-std::pow(spacing * static_cast<double>(i), 2));
    }
    weight /= std::sqrt(weight.square().sum());
    ArrayXXd along = ArrayXXd::Zero(rows, white.cols());
    for (Index i = 0; i < weight.size(); ++i) along += weight(i) * white.middleRows(i, rows);
    field_.z.setZero();
    for (Index i = 0; i < weight.size(); ++i) field_.z += weight(i) * along.middleCols(i, cols);
  }
  double at(double x, double y) const { return height_at(field_, x, y); }

 private:
  static constexpr double spacing = 0.25;  // of nodes over the length; ours
  HeightMap field_;
};

/// A sensor and how it looks.
struct Place {
  Vector3d sensor;
  Vector3d axis;    ///< of the field of view
  Vector3d across;  ///< level
};

/// One look from one place.
class Look {
 public:
  Look(const HeightMap& surface, const SiteSensor& sensor, const SiteLooks& looks, Place place)
      : surface_(surface), sensor_(sensor), looks_(looks), place_(std::move(place)) {}

  /// Calls take(direction, range) for the rays of a vertical plane.
  template <typename Take>
  void along(double azimuth, const Take& take) const {
    const Vector2d ahead(std::cos(azimuth), std::sin(azimuth));
    const double step = 0.5 * surface_.cell_size;
    double last_r = looks_.nearest, last_z = height(ahead, last_r);
    double elevation = steepest();
    for (double r = last_r + step; r <= looks_.range && elevation < highest; r += step) {
      const double z = height(ahead, r);
      if (std::isnan(z)) return;
      while (elevation < highest && std::tan(elevation) * r <= z - place_.sensor.z()) {
        const Vector3d ray(ahead.x() * std::cos(elevation), ahead.y() * std::cos(elevation),
                           std::sin(elevation));
        const double slope = std::tan(elevation);
        const double before = slope * last_r + place_.sensor.z() - last_z;
        const double after = slope * r + place_.sensor.z() - z;
        const bool is_met = before > 0.0;
        const double met = last_r + (r - last_r) * before / (before - after);
        const double range = met / std::cos(elevation);
        if (is_met && range <= looks_.range && sees(ray)) take(ray, range);
        elevation += step_at(elevation);
      }
      last_r = r;
      last_z = z;
    }
  }

 private:
  static constexpr double highest = 0.2;  // of a ray [rad]; ours

  double height(const Vector2d& ahead, double r) const {
    return height_at(surface_, place_.sensor.x() + r * ahead.x(),
                     place_.sensor.y() + r * ahead.y());
  }
  double step_at(double elevation) const {
    const double down = std::sin(elevation);
    return std::max(looks_.step.y(), looks_.spacing * down * down / sensor_.height);
  }
  double steepest() const {
    return std::max(-0.5 * pi + 0.02, -sensor_.tilt - 0.5 * sensor_.view.y());
  }
  bool sees(const Vector3d& ray) const {
    const Vector3d down = place_.axis.cross(place_.across);
    const double depth = ray.dot(place_.axis), across = ray.dot(place_.across);
    const double off = std::atan2(across, depth);
    const double up = std::asin(std::clamp(ray.dot(down), -1.0, 1.0));
    const double along = sensor_.view.x() < pi ? std::atan2(ray.dot(down), depth) : up;
    return std::abs(off) <= 0.5 * sensor_.view.x() && std::abs(along) <= 0.5 * sensor_.view.y();
  }

  const HeightMap& surface_;
  const SiteSensor& sensor_;
  const SiteLooks& looks_;
  Place place_;
};

Place place_of(const SiteSensor& sensor, const SiteLooks& looks, const BasePose& base,
               double swing) {
  const double heading = base.heading + swing;
  const Vector3d ahead(std::cos(heading), std::sin(heading), 0.0);
  const Vector3d left(-ahead.y(), ahead.x(), 0.0);
  Place place;
  place.sensor = Vector3d(base.x, base.y, base.z + sensor.height) + looks.mount.x() * ahead +
                 looks.mount.y() * left;
  place.axis = std::cos(sensor.tilt) * ahead - std::sin(sensor.tilt) * Vector3d::UnitZ();
  place.across = left;
  return place;
}

/// The errors that all points of a scan share.
struct Registration {
  Registration(const SiteSensor& sensor, const BasePose& about, std::uint64_t seed) : base(about) {
    Random random(seed, registration_stream);
    height = sensor.height_sd * random.normal();
    tilt.x() = sensor.tilt_sd * random.normal();
    tilt.y() = sensor.tilt_sd * random.normal();
  }
  Vector3d moved(Vector3d point) const {
    point.z() += height + tilt.x() * (point.x() - base.x) + tilt.y() * (point.y() - base.y);
    return point;
  }
  BasePose base;
  double height = 0.0;
  Vector2d tilt;
};

}  // namespace

SiteLooks looks_of(const SiteSensor& sensor) {
  if (sensor.on_boom) {
    const std::vector<double> swings = {-50.0 * degree, 0.0, 50.0 * degree};
    return {{1.5, 0.0}, swings, 70.0 * degree, 0.5, 7.0, 0.03, {0.008, 0.0032}};
  }
  return {{0.6, 0.7},     {-60.0 * degree, 0.0, 60.0 * degree}, 64.0 * degree, 0.5, 12.0, 0.03,
          {0.006, 0.0021}};
}

HeightMap with_obstacles(const HeightMap& surface, const std::vector<JobObstacle>& obstacles) {
  HeightMap seen = surface;
  for (const JobObstacle& obstacle : obstacles) {
    for_each_cell(seen.z, [&](Cell at) {
      if (!is_near(obstacle.polygon, {seen.x(at.col), seen.y(at.row)}, 0.5 * seen.cell_size))
        return;
      seen.z(at.row, at.col) = surface.z(at.row, at.col) + obstacle.height;
    });
  }
  return seen;
}

Scan scan_site(const HeightMap& seen, const SiteSensor& sensor, const BasePose& base,
               std::uint64_t seed) {
  require_map(seen, "scan of a site: surface");
  const SiteLooks looks = looks_of(sensor);
  const Registration registration(sensor, base, seed);
  const double room = looks.range + looks.mount.norm() + 1.0;
  const Pattern pattern({base.x - room, base.y - room, base.x + room, base.y + room}, seed);
  Scan scan;
  scan.z_is_up = true;
  scan.name = "scan of the site";
  for (std::size_t i = 0; i < looks.swings.size(); ++i) {
    const Place place = place_of(sensor, looks, base, looks.swings[i]);
    const Look look(seen, sensor, looks, place);
    auto cloud = std::make_shared<Cloud>();
    cloud->sensor_origin = place.sensor;
    Random random(seed, look_stream, i);
    const double middle = base.heading + looks.swings[i];
    const int rays = static_cast<int>(looks.sector / looks.step.x());
    for (int k = 0; k <= rays; ++k) {
      const double azimuth = middle - 0.5 * looks.sector + k * looks.step.x();
      look.along(azimuth, [&](const Vector3d& ray, double range) {
        const double grown = std::pow(range, sensor.range_power);
        const Vector3d at = place.sensor + range * ray;
        const double off =
            grown * (sensor.noise * random.normal() + sensor.pattern * pattern.at(at.x(), at.y()));
        cloud->points.push_back(registration.moved(at + off * ray));
      });
    }
    cloud->width = cloud->points.size();
    if (cloud->width > 0) scan.clouds.push_back(cloud);
  }
  return scan;
}

}  // namespace excavplan
