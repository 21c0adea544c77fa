// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/machine.hpp>

#include <cmath>

#include "base/text.hpp"

namespace excavplan {
namespace {

/// Numbers in the order they are given, as text.
class Numbers {
 public:
  Numbers& operator<<(double number) {
    text_ += number_text(number) + ' ';
    return *this;
  }
  Numbers& operator<<(const Eigen::Vector2d& point) { return *this << point.x() << point.y(); }
  std::string digest() const { return checksum_text(text_); }

 private:
  std::string text_;
};

void add_bucket(const Bucket& bucket, Numbers& numbers) {
  for (const Eigen::Vector2d& corner : bucket.profile) numbers << corner;
  numbers << bucket.width_outside << bucket.width_inside << bucket.edge_thickness
          << bucket.edge_angle << (bucket.teeth ? 1.0 : 0.0);
  if (const auto& teeth = bucket.teeth) {
    numbers << teeth->count << teeth->width << teeth->thickness << teeth->length << teeth->angle;
  }
}

void add_hydraulics(const Machine& machine, Numbers& numbers) {
  numbers << (machine.cylinders ? 1.0 : 0.0) << (machine.hydraulics ? 1.0 : 0.0);
  if (machine.cylinders) {
    for (const Cylinder& cylinder : *machine.cylinders) {
      // Computed lengths: rounded, so that they are the same with every mathematical library.
      numbers << cylinder.count() << std::round(1e6 * cylinder.shortest())
              << std::round(1e6 * cylinder.longest());
    }
  }
  if (machine.hydraulics) {
    for (const Piston& piston : machine.hydraulics->pistons) {
      numbers << piston.diameter << piston.rod_diameter << piston.speed;
    }
    numbers << machine.hydraulics->pump_flow;
  }
}

void add_body_and_drive(const Machine& machine, Numbers& numbers) {
  numbers << (machine.body ? 1.0 : 0.0) << (machine.swing ? 1.0 : 0.0)
          << (machine.engine ? 1.0 : 0.0);
  if (const auto& body = machine.body) {
    numbers << body->mass << body->centre << body->rear_edge << body->front_edge
            << body->track_friction;
  }
  if (const auto& swing = machine.swing) {
    numbers << swing->speed << swing->torque << swing->inertia;
    if (std::isfinite(swing->acceleration)) numbers << swing->acceleration;
  }
  if (const auto& engine = machine.engine) numbers << engine->power << engine->idle_power;
}

}  // namespace

std::string fingerprint(const Machine& machine) {
  Numbers numbers;
  numbers << machine.boom_pin << machine.boom_length << machine.arm_length << machine.bucket_length
          << machine.track_front;
  for (const JointLimits& limits : machine.limits) {
    numbers << limits.lower << limits.upper << limits.speed << limits.acceleration << limits.torque;
  }
  for (const LinkMass& link : machine.links) numbers << link.mass << link.along << link.across;
  add_bucket(machine.bucket, numbers);
  add_hydraulics(machine, numbers);
  add_body_and_drive(machine, numbers);
  if (const Attitude& stands = machine.attitude; !stands.is_level()) {
    numbers << stands.roll << stands.pitch;
  }
  return numbers.digest();
}

}  // namespace excavplan
