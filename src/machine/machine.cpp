// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/machine.hpp>

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

double double_area(const std::vector<Vector2d>& polygon) {
  double sum = cross(polygon.back(), polygon.front());
  for (std::size_t i = 1; i < polygon.size(); ++i) sum += cross(polygon[i - 1], polygon[i]);
  return sum;
}

}  // namespace

const char* name(Joint joint) {
  switch (joint) {
    case Joint::boom:
      return "boom";
    case Joint::arm:
      return "arm";
    case Joint::bucket:
      return "bucket";
  }
  return "unknown joint";
}

double Machine::beta() const {
  require(bucket.profile.size() >= 2, "corners of the bucket's profile",
          static_cast<double>(bucket.profile.size()), "at least 2");
  const Vector2d floor = bucket.profile[1] - bucket.profile[0];
  return std::atan2(floor.y(), -floor.x());
}

Eigen::Matrix3d Attitude::to_site() const {
  return Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

Eigen::Vector3d Attitude::up() const {
  if (is_level()) return Eigen::Vector3d::UnitZ();
  return to_site().row(2).transpose();
}

Vector2d Machine::up(double swung) const {
  if (attitude.is_level()) return Vector2d::UnitY();
  const Eigen::Vector3d against = attitude.up();
  return {std::cos(swung) * against.x() + std::sin(swung) * against.y(), against.z()};
}

Machine with_attitude(Machine machine, const Attitude& attitude) {
  machine.attitude = attitude;
  return machine;
}

double Machine::swing_reach() const {
  return std::hypot(std::abs(boom_pin.x()) + full_length(), 0.5 * bucket.width_outside);
}

double Machine::undercarriage_width() const {
  constexpr double of_zx120 = 2.6 / 1.8;
  return track_width.value_or(of_zx120 * std::max(0.0, track_front));
}

double Machine::tail_swing_radius() const {
  constexpr double of_track_front = 1.35;
  return tail_radius.value_or(of_track_front * std::max(0.0, track_front));
}

double struck_capacity(const Machine& machine) {
  require_in("corners of the bucket's profile", static_cast<double>(machine.bucket.profile.size()),
             3.0, 1000.0);
  const double volume = 0.5 * double_area(machine.bucket.profile) * machine.bucket.width_inside;
  require(volume > 0.0 && std::isfinite(volume), "capacity of the bucket", volume,
          "above 0 m^3 and finite");
  return volume;
}

double heaped_capacity(const Machine& machine, double slope) {
  constexpr double steepest = 1.5;  // [rad]
  require_in("slope of the heap on the bucket", slope, 0.0, steepest);
  const double struck = struck_capacity(machine);
  const double mouth = (machine.bucket.profile.front() - machine.bucket.profile.back()).norm();
  const auto [narrow, wide] = std::minmax({mouth, machine.bucket.width_inside});
  const double hipped_roof =
      std::tan(slope) * narrow * narrow * (0.25 * wide - narrow / 12.0);  // ISO 7451 at 1:1
  require(std::isfinite(hipped_roof), "heap on the bucket", hipped_roof, "finite");
  return struck + hipped_roof;
}

}  // namespace excavplan
