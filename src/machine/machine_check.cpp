// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>

#include <excavplan/machine/machine.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "machine/machine_check.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

constexpr double longest = 100.0;  // as load_machine() [m]
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Texts are made only of what breaks a rule: the checks run before every path.
class Rules {
 public:
  explicit Rules(const Machine& machine) : machine_(machine) {}

  void in(const char* of, const char* member, double value, double lowest, double highest) const {
    if (value >= lowest && value <= highest) return;
    require_in(place(of, member), value, lowest, highest);
  }
  void positive(const char* of, const char* member, double value, double highest) const {
    constexpr double smallest = 1e-9;  // a smaller one overflows what is divided by it
    if (value >= smallest && value <= highest) return;
    require(false, place(of, member), value, "above 0 and at most " + number_text(highest));
  }
  void below(const char* of, const char* member, double value, double limit) const {
    if (value < limit) return;
    require(false, place(of, member), value, "below " + number_text(limit));
  }
  void holds(bool what, const char* text) const {
    if (!what) refuse("machine " + excavplan::quoted(machine_.name) + ": " + text);
  }

 private:
  std::string place(const char* of, const char* member) const {
    return "machine " + excavplan::quoted(machine_.name) + ": " + of + member;
  }

  const Machine& machine_;
};

void check_joint(const Rules& rules, Joint joint, const JointLimits& limits, const LinkMass& link) {
  const char* of = name(joint);
  const double lowest = joint == Joint::arm ? 0.0 : -pi;
  rules.in(of, " limits.lower", limits.lower, lowest, pi);
  rules.in(of, " limits.upper", limits.upper, lowest, pi);
  rules.below(of, " limits.lower", limits.lower, limits.upper);
  rules.positive(of, " limits.speed", limits.speed, 100.0);
  rules.positive(of, " limits.acceleration", limits.acceleration, 1e4);
  rules.positive(of, " limits.torque", limits.torque, infinity);
  rules.in(of, " link.mass", link.mass, 0.0, 1e6);
  rules.in(of, " link.along", link.along, -longest, longest);
  rules.in(of, " link.across", link.across, -longest, longest);
}

void check_bucket(const Rules& rules, const Machine& machine) {
  const Bucket& bucket = machine.bucket;
  for (const Eigen::Vector2d& corner : bucket.profile) {
    rules.in("bucket.", "profile", corner.x(), -longest, longest);
    rules.in("bucket.", "profile", corner.y(), -longest, longest);
  }
  rules.positive("bucket.", "width_outside", bucket.width_outside, longest);
  rules.positive("bucket.", "width_inside", bucket.width_inside, longest);
  rules.positive("bucket.", "edge_thickness", bucket.edge_thickness, 1.0);
  rules.positive("bucket.", "edge_angle", bucket.edge_angle, pi / 2.0);
  if (const auto& teeth = bucket.teeth) {
    rules.in("bucket.teeth.", "count", teeth->count, 1.0, 50.0);
    rules.positive("bucket.teeth.", "width", teeth->width, longest);
    rules.positive("bucket.teeth.", "thickness", teeth->thickness, 1.0);
    rules.positive("bucket.teeth.", "length", teeth->length, 1.0);
    rules.positive("bucket.teeth.", "angle", teeth->angle, pi / 2.0);
    rules.below("bucket.teeth.", "angle", teeth->angle, pi / 2.0);
  }
  check_shape(bucket, machine.bucket_length, machine.boom_length,
              [&](const char* key, const std::string& what) {
                rules.holds(false, (std::string("bucket.") + key + " " + what).c_str());
              });
}

void check_hydraulics(const Rules& rules, const Machine& machine) {
  if (!machine.hydraulics) return;
  rules.holds(machine.cylinders.has_value(), "hydraulics need cylinders, it has none");
  rules.positive("hydraulics.", "pump_flow", machine.hydraulics->pump_flow, 1.0);
  for (const Piston& piston : machine.hydraulics->pistons) {
    rules.positive("hydraulics.pistons.", "diameter", piston.diameter, 1.0);
    rules.positive("hydraulics.pistons.", "rod_diameter", piston.rod_diameter, 1.0);
    rules.below("hydraulics.pistons.", "rod_diameter", piston.rod_diameter, piston.diameter);
    rules.positive("hydraulics.pistons.", "speed", piston.speed, infinity);
  }
}

void check_rest(const Rules& rules, const Machine& machine) {
  if (const auto& body = machine.body) {
    rules.positive("body.", "mass", body->mass, 1e6);
    rules.positive("body.", "centre.z", body->centre.y(), longest);
    rules.in("body.", "rear_edge", body->rear_edge, -longest, longest);
    rules.in("body.", "front_edge", body->front_edge, -longest, longest);
    rules.below("body.", "rear_edge", body->rear_edge, body->centre.x());
    rules.below("body.", "centre.x", body->centre.x(), body->front_edge);
    rules.positive("body.", "track_friction", body->track_friction, 2.0);
  }
  if (const auto& swing = machine.swing) {
    rules.positive("swing.", "speed", swing->speed, 100.0);
    rules.positive("swing.", "torque", swing->torque, 1e9);
    rules.positive("swing.", "inertia", swing->inertia, 1e9);
  }
  if (const auto& engine = machine.engine) {
    rules.positive("engine.", "power", engine->power, 1e8);
    rules.in("engine.", "idle_power", engine->idle_power, 0.0, 1e8);
  }
}

}  // namespace

void check_shape(const Bucket& bucket, double bucket_length, double boom_length,
                 const std::function<void(const char* key, const std::string& what)>& fail) {
  constexpr double rounding = 1e-9;  // [m]
  const auto& profile = bucket.profile;
  if (profile.size() < 3 || profile.size() > 1000) {
    fail("profile", "has " + std::to_string(profile.size()) + " corners, must have 3 .. 1000");
  }
  const Eigen::Vector2d& tip = profile.front();
  if ((tip - Eigen::Vector2d(bucket_length, 0.0)).norm() > rounding) {
    fail("profile", "begins at (" + number_text(tip.x()) + ", " + number_text(tip.y()) +
                        "), must begin at the tip (" + number_text(bucket_length) + ", 0)");
  }
  if (!is_convex(profile)) fail("profile", "must be convex and run counter-clockwise");
  if (profile[1].y() <= 0.0) {
    fail("profile", "has its heel at across_m = " + number_text(profile[1].y()) +
                        ", must be above 0, the line from bucket pin to tip");
  }
  const auto at_most = [&](const char* key, double value, const char* other, double limit) {
    if (value <= limit + rounding) return;
    fail(key,
         "is " + number_text(value) + ", must not exceed " + other + " = " + number_text(limit));
  };
  at_most("width_outside_m", bucket.width_outside, "boom_length_m", boom_length);
  at_most("width_inside_m", bucket.width_inside, "width_outside_m", bucket.width_outside);
  if (const auto& teeth = bucket.teeth;
      teeth && teeth->count * teeth->width > bucket.width_outside + rounding) {
    fail("teeth.width_m",
         "is " + number_text(teeth->width) + ", " + number_text(teeth->count) +
             " teeth must not exceed width_outside_m = " + number_text(bucket.width_outside));
  }
}

void require_machine(const Machine& machine) {
  const Rules rules(machine);
  rules.in("", "boom_pin.x", machine.boom_pin.x(), -longest, longest);
  rules.in("", "boom_pin.z", machine.boom_pin.y(), -longest, longest);
  rules.positive("", "boom_length", machine.boom_length, longest);
  rules.positive("", "arm_length", machine.arm_length, longest);
  rules.positive("", "bucket_length", machine.bucket_length, longest);
  rules.in("", "track_front", machine.track_front, -longest, longest);
  for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
    const auto i = static_cast<std::size_t>(joint);
    check_joint(rules, joint, machine.limits[i], machine.links[i]);
  }
  check_bucket(rules, machine);
  check_hydraulics(rules, machine);
  check_rest(rules, machine);
}

}  // namespace excavplan
