// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "scans/sensor_look.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/statistics.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Numbers of our own choice.
constexpr double slack = 0.01;  // by which a ray may be within the ground that it passes [m]
constexpr double outermost =
    0.02;  // share of a cloud's points beside the sector that is counted on

/// The highest ground between the eye and a place lies below the line of sight.
bool is_open(const HeightMap& surface, const Vector3d& eye, const Vector3d& at) {
  const Vector3d way = eye - at;
  const double length = way.head<2>().norm();
  for (double r = surface.cell_size; r < length; r += surface.cell_size) {
    const Vector3d on = at + way * (r / length);
    if (height_at(surface, on.x(), on.y()) > on.z() + slack) return false;
  }
  return true;
}

/// What points about their sensor say of its view; its azimuth is that of the site.
SensorLook look_along(const std::vector<Vector3d>& ways) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector3d& way : ways) sum += way.head<2>().normalized();
  const double middle = std::atan2(sum.y(), sum.x());
  std::vector<double> off, ranges, steep;
  for (const Vector3d& way : ways) {
    off.push_back(wrapped(std::atan2(way.y(), way.x()) - middle));
    ranges.push_back(way.head<2>().norm());
    steep.push_back(std::atan2(-way.z(), ranges.back()));
  }
  const double right = quantile(off, outermost), left = quantile(off, 1.0 - outermost);
  SensorLook look;
  look.azimuth = middle + 0.5 * (left + right);
  look.half_sector = 0.5 * (left - right);
  look.range = quantile(std::move(ranges), 1.0 - outermost);
  look.steepest = quantile(std::move(steep), 1.0 - outermost);
  return look;
}

}  // namespace

std::vector<SensorLook> looks_of(const Scan& scan, const BasePose& base) {
  std::vector<SensorLook> looks;
  const Eigen::Isometry3d site_from_scan(scan.site_from_scan);
  const Eigen::Rotation2Dd back(-base.heading);
  for (const auto& cloud : scan.clouds) {
    if (!cloud->sensor_origin) continue;
    const Vector3d eye = site_from_scan * (scan.unit * *cloud->sensor_origin);
    std::vector<Vector3d> ways;
    for (const Vector3d& point : cloud->points) {
      if (point.allFinite()) ways.emplace_back(site_from_scan * (scan.unit * point) - eye);
    }
    if (ways.empty()) continue;
    SensorLook look = look_along(ways);
    look.from.head<2>() = back * (eye.head<2>() - Vector2d(base.x, base.y));
    look.from.z() = eye.z() - base.z;
    look.azimuth = wrapped(look.azimuth - base.heading);
    looks.push_back(look);
  }
  return looks;
}

std::vector<SensorLook> usual_looks() { return {{{0.6, 0.0, 3.0}, 0.0, pi, 12.0, 1.0}}; }

bool sees(const SensorLook& look, const BasePose& base, const HeightMap& surface,
          const Vector3d& at) {
  const Eigen::Rotation2Dd turn(base.heading);
  const Vector2d eye = Vector2d(base.x, base.y) + turn * look.from.head<2>();
  const Vector2d way = at.head<2>() - eye;
  const double height = base.z + look.from.z() - at.z();
  if (way.norm() > look.range || std::atan2(height, way.norm()) > look.steepest) return false;
  const double azimuth = std::atan2(way.y(), way.x()) - base.heading - look.azimuth;
  if (std::abs(wrapped(azimuth)) > look.half_sector) return false;
  return is_open(surface, {eye.x(), eye.y(), at.z() + height}, at);
}

}  // namespace excavplan
