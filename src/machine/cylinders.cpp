// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/cylinders.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double rounding = 1e-12;         // [m]
constexpr double round_trip_error = 1e-9;  // [rad]
constexpr double least_lever = 1e-3;       // of that in the middle of the range
constexpr int proof_steps = 1000;

/// All points are relative to the joint: its pin is the origin, +x the direction of the link
/// before.
const Vector2d joint_pin(0.0, 0.0);

Vector2d quarter_turn(const Vector2d& v) { return {-v.y(), v.x()}; }

/// A pin after its link has turned clockwise by `joint`.
Vector2d turned(const PolarPin& pin, double joint) {
  return pin.distance * Vector2d(std::cos(pin.angle - joint), std::sin(pin.angle - joint));
}

Vector2d fixed(const PolarPin& pin) { return turned(pin, 0.0); }

double side_of(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
  return cross(to - from, point - from) < 0.0 ? -1.0 : 1.0;
}

void require_finite(const CylinderGeometry& geometry) {
  const auto check = [](const PolarPin& pin, const std::string& what) {
    if (std::isfinite(pin.distance) && std::isfinite(pin.angle)) return;
    refuse("has a " + what + " at distance " + number_text(pin.distance) + " and angle " +
           number_text(pin.angle) + ", must be finite");
  };
  check(geometry.foot, "foot");
  if (const auto* rod = std::get_if<PolarPin>(&geometry.rod)) check(*rod, "rod");
  if (const auto* bars = std::get_if<FourBar>(&geometry.rod)) {
    check(bars->rocker.pin, "rocker");
    check(bars->link.pin, "link");
    const double lengths = bars->rocker.length + bars->link.length;
    if (!std::isfinite(lengths)) refuse("has a rocker or link whose length is not finite");
  }
}

/// The point this far from both ends, on the left (side +1) or right (-1); NaN if there is none.
Vector2d apex(const Vector2d& from, const Vector2d& to, double to_from, double to_to, double side) {
  const Vector2d base = to - from;
  const double length = base.norm();
  const double along = (length * length + to_from * to_from - to_to * to_to) / (2.0 * length);
  const double across = side * std::sqrt((to_from - along) * (to_from + along));
  return from + (along * base + across * quarter_turn(base)) / length;
}

}  // namespace

Cylinder::Cylinder(const CylinderGeometry& geometry, double lower, double upper)
    : geometry_(geometry),
      foot_(fixed(geometry.foot)),
      rocker_pin_(joint_pin),
      lower_(lower),
      upper_(upper) {
  if (const auto* bars = std::get_if<FourBar>(&geometry.rod)) rocker_pin_ = fixed(bars->rocker.pin);
  require_finite(geometry);
  if (geometry.count < 1) refuse("has count " + std::to_string(geometry.count) + ", must be >= 1");
  if (!(lower < upper && std::isfinite(upper - lower))) {
    refuse("has a joint range from " + number_text(lower) + " to " + number_text(upper) +
           " rad, must rise");
  }
  choose_assembly();
  std::tie(shortest_, longest_) = std::minmax({at(lower).length, at(upper).length});
  prove_one_to_one();
  if (longest_ >= 2.0 * shortest_) {
    refuse("is " + number_text(shortest_) + " .. " + number_text(longest_) +
           " m long over the range of its joint; a cylinder must stay below twice its shortest");
  }
}

void Cylinder::choose_assembly() {
  const double middle = 0.5 * (lower_ + upper_);
  if (const auto* bars = std::get_if<FourBar>(&geometry_.rod)) {
    const Vector2d link_pin = turned(bars->link.pin, middle);
    loop_side_ = -side_of(rocker_pin_, link_pin, joint_pin);
    link_side_ = side_of(joint_pin, rod_end(middle).position, link_pin);
  }
  rod_side_ = side_of(rocker_pin_, foot_, rod_end(middle).position);
}

void Cylinder::prove_one_to_one() const {
  const auto refuse_dead_point = [this](double joint) {
    refuse("has a dead point at or near joint angle " + number_text(joint) +
           " rad; its length must rise or fall all the way from " + number_text(lower_) + " to " +
           number_text(upper_) + " rad");
  };
  const auto sample = [this](int i) { return lower_ + (upper_ - lower_) * i / proof_steps; };
  const double middle_lever = at(0.5 * (lower_ + upper_)).lever;
  for (int i = 0; i <= proof_steps; ++i) {
    const CylinderState state = at(sample(i));
    if (std::isnan(state.length)) {
      refuse("cannot be assembled at joint angle " + number_text(sample(i)) +
             " rad: its parts do not meet");
    }
    if (!(state.lever / middle_lever > least_lever)) refuse_dead_point(sample(i));
  }
  for (int i = 0; i <= proof_steps; ++i) {
    const std::optional<double> back = joint_angle(at(sample(i)).length);
    if (!back || !(std::abs(*back - sample(i)) <= round_trip_error)) refuse_dead_point(sample(i));
  }
}

Cylinder::RodEnd Cylinder::rod_end(double joint) const {
  if (const auto* rod = std::get_if<PolarPin>(&geometry_.rod)) {
    const Vector2d position = turned(*rod, joint);
    return {position, -quarter_turn(position)};
  }
  const auto& bars = std::get<FourBar>(geometry_.rod);
  const Vector2d link_pin = turned(bars.link.pin, joint);
  const Vector2d position =
      apex(rocker_pin_, link_pin, bars.rocker.length, bars.link.length, loop_side_);
  // The link is rigid: both its ends have the same velocity along it.
  const Vector2d link = position - link_pin;
  const Vector2d across_rocker = quarter_turn(position - rocker_pin_);
  return {position, across_rocker * (link.dot(-quarter_turn(link_pin)) / link.dot(across_rocker))};
}

CylinderState Cylinder::at(double joint) const {
  const RodEnd rod = rod_end(joint);
  const Vector2d cylinder = rod.position - foot_;
  const double length = cylinder.norm();
  return {length, cylinder.dot(rod.velocity) / length};
}

double Cylinder::solve(double length) const {
  if (const auto* rod = std::get_if<PolarPin>(&geometry_.rod)) {
    const Vector2d position = apex(joint_pin, foot_, rod->distance, length, rod_side_);
    return rod->angle - std::atan2(position.y(), position.x());
  }
  const auto& bars = std::get<FourBar>(geometry_.rod);
  const Vector2d rod = apex(rocker_pin_, foot_, bars.rocker.length, length, rod_side_);
  const Vector2d link_pin =
      apex(joint_pin, rod, bars.link.pin.distance, bars.link.length, link_side_);
  return bars.link.pin.angle - std::atan2(link_pin.y(), link_pin.x());
}

std::optional<double> Cylinder::joint_angle(double length) const {
  if (!(length >= shortest_ - rounding && length <= longest_ + rounding)) return std::nullopt;
  const double middle = 0.5 * (lower_ + upper_);
  const double angle = solve(length);
  return std::clamp(middle + std::remainder(angle - middle, 2.0 * pi), lower_, upper_);
}

double Cylinder::force(double joint, double torque) const {
  return torque / (geometry_.count * at(joint).lever);
}

std::array<CylinderState, 3> cylinder_states(const Cylinders& cylinders,
                                             const Eigen::Vector3d& joints) {
  return {cylinders[0].at(joints[0]), cylinders[1].at(joints[1]), cylinders[2].at(joints[2])};
}

Eigen::Vector3d cylinder_forces(const Cylinders& cylinders, const Eigen::Vector3d& joints,
                                const Eigen::Vector3d& torque) {
  return {cylinders[0].force(joints[0], torque[0]), cylinders[1].force(joints[1], torque[1]),
          cylinders[2].force(joints[2], torque[2])};
}

double Piston::area_filled(double growth) const {
  const double rod = growth < 0.0 ? rod_diameter : 0.0;
  return 0.25 * pi * (diameter * diameter - rod * rod);
}

}  // namespace excavplan
