// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/machine_check.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <excavplan/machine/kinematics.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

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
    if (!what) refuse("machine " + in_quotes(machine_.name) + ": " + text);
  }

 private:
  std::string place(const char* of, const char* member) const {
    return "machine " + in_quotes(machine_.name) + ": " + of + member;
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
  rules.in(of, " link.along", link.along, -longest_part, longest_part);
  rules.in(of, " link.across", link.across, -longest_part, longest_part);
}

void check_bucket(const Rules& rules, const Machine& machine) {
  const Bucket& bucket = machine.bucket;
  for (const Eigen::Vector2d& corner : bucket.profile) {
    rules.in("bucket.", "profile", corner.x(), -longest_part, longest_part);
    rules.in("bucket.", "profile", corner.y(), -longest_part, longest_part);
  }
  rules.positive("bucket.", "width_outside", bucket.width_outside, longest_part);
  rules.positive("bucket.", "width_inside", bucket.width_inside, longest_part);
  rules.positive("bucket.", "edge_thickness", bucket.edge_thickness, 1.0);
  rules.positive("bucket.", "edge_angle", bucket.edge_angle, pi / 2.0);
  if (const auto& teeth = bucket.teeth) {
    rules.in("bucket.teeth.", "count", teeth->count, 1.0, 50.0);
    rules.positive("bucket.teeth.", "width", teeth->width, longest_part);
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
    rules.positive("body.", "centre.z", body->centre.y(), longest_part);
    rules.in("body.", "rear_edge", body->rear_edge, -longest_part, longest_part);
    rules.in("body.", "front_edge", body->front_edge, -longest_part, longest_part);
    rules.below("body.", "rear_edge", body->rear_edge, body->centre.x());
    rules.below("body.", "centre.x", body->centre.x(), body->front_edge);
    rules.positive("body.", "track_friction", body->track_friction, 2.0);
  }
  if (const auto& swing = machine.swing) {
    rules.positive("swing.", "speed", swing->speed, 100.0);
    rules.positive("swing.", "torque", swing->torque, 1e9);
    rules.positive("swing.", "inertia", swing->inertia, 1e9);
    rules.positive("swing.", "acceleration", swing->acceleration, infinity);
    rules.in("swing.", "lower", swing->lower, -infinity, infinity);
    rules.below("swing.", "lower", swing->lower, swing->upper);
  }
  if (const auto& engine = machine.engine) {
    rules.positive("engine.", "power", engine->power, 1e8);
    rules.in("engine.", "idle_power", engine->idle_power, 0.0, 1e8);
  }
}

/// A number of the file, measured by others that grow with the machine as it does.
struct UnitRule {
  std::string key;
  double value;
  double measure;
  const char* of;  ///< what the measure is, after its number; empty: it is the value
  double lowest;
  double highest;
  const char* hint;
};

constexpr const char* if_degrees = "is it in degrees or turns?";
constexpr const char* if_tonnes = "is it in t?";
constexpr const char* if_kilo = "is it in kN m?";

/// Boom, arm and bucket stretched out level.
struct LevelFront {
  double mass = 0.0;    ///< [kg]
  double moment = 0.0;  ///< of their weight about the pin of the boom [N m]
};

void add_swing_rules(const Swing& swing, double length, const LevelFront& front,
                     std::vector<UnitRule>& rules) {
  rules.push_back({"swing.speed_rad_per_s", swing.speed, swing.speed, "", 0.01, 5.0, if_degrees});
  rules.push_back({"swing.torque_n_m", swing.torque, front.moment / swing.torque,
                   "of which holds boom, arm and bucket stretched out level", 0.0, 50.0, if_kilo});
  rules.push_back({"swing.inertia_kg_m2", swing.inertia,
                   swing.inertia / (front.mass * length * length),
                   "of boom, arm and bucket at the length of both", 0.002, 20.0, "is it in t m2?"});
  if (std::isfinite(swing.acceleration)) {
    rules.push_back({"swing.acceleration_rad_per_s2", swing.acceleration, swing.acceleration, "",
                     0.01, 5.0, if_degrees});
  }
}

// Ours: machines of 1 to 100 t, with long fronts too, lie inside by a factor of 2 or more; a wrong
// unit is a factor of 57 (degrees) or 1000.
std::vector<UnitRule> unit_rules(const Machine& machine) {
  const JointAngles stretched = JointAngles::Zero();
  const JointAngles own_weight =
      torque_against_link_weight(machine, link_positions(machine, stretched)).cwiseAbs();
  const double length = machine.boom_length + machine.arm_length;
  double front = 0.0;
  std::vector<UnitRule> rules = {{"geometry.boom_pin_m[1]", machine.boom_pin.y(),
                                  machine.boom_pin.y() / machine.boom_length,
                                  "of boom_length_m above the ground", 0.01, 2.0,
                                  "the ground that the machine stands on is z = 0"}};
  for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
    const auto i = static_cast<std::size_t>(joint);
    const JointLimits& limits = machine.limits[i];
    const double mass = machine.links[i].mass;
    const double load = own_weight(static_cast<Eigen::Index>(i));
    const std::string key = std::string(name(joint)) + '.';
    front += mass;
    rules.push_back({"links." + key + "mass_kg", mass, mass / std::pow(length, 3),
                     "kg per cubed length of boom and arm", 0.02, 50.0, if_tonnes});
    rules.push_back({"joints." + key + "speed_rad_per_s", limits.speed, limits.speed, "", 0.01, 5.0,
                     if_degrees});
    rules.push_back({"joints." + key + "torque_n_m", limits.torque, load / limits.torque,
                     "of which holds the links stretched out level", 0.0, 1.0, if_kilo});
  }
  if (const auto& body = machine.body) {
    rules.push_back({"body.mass_kg", body->mass, body->mass / front, "of boom, arm and bucket", 1.0,
                     100.0, if_tonnes});
  }
  if (const auto& swing = machine.swing) {
    add_swing_rules(*swing, length, {front, own_weight(0)}, rules);
  }
  if (const auto& engine = machine.engine) {
    rules.push_back({"engine.power_w", engine->power, engine->power / front,
                     "W per kg of boom, arm and bucket", 2.0, 1000.0, "is it in kW?"});
    rules.push_back({"engine.idle_power_w", engine->idle_power, engine->idle_power / engine->power,
                     "of power_w", 0.0, 1.0, "an idling engine takes less than it can give"});
  }
  return rules;
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

void check_units(const Machine& machine,
                 const std::function<void(const std::string& key, const std::string& what)>& fail) {
  for (const UnitRule& rule : unit_rules(machine)) {
    if (rule.measure >= rule.lowest && rule.measure <= rule.highest) continue;
    const std::string is = "is " + number_text(rule.value);
    const std::string range = number_text(rule.lowest) + " .. " + number_text(rule.highest);
    fail(rule.key, is + (*rule.of ? ", " + readable(rule.measure) + " " + rule.of : "") +
                       ", must be in " + range + ": " + rule.hint);
  }
}

void require_machine(const Machine& machine) {
  const Rules rules(machine);
  rules.in("", "boom_pin.x", machine.boom_pin.x(), -longest_part, longest_part);
  rules.in("", "boom_pin.z", machine.boom_pin.y(), -longest_part, longest_part);
  rules.positive("", "boom_length", machine.boom_length, longest_part);
  rules.positive("", "arm_length", machine.arm_length, longest_part);
  rules.positive("", "bucket_length", machine.bucket_length, longest_part);
  rules.in("", "track_front", machine.track_front, -longest_part, longest_part);
  constexpr double steepest = 0.8;  // [rad]; ours: no machine stands on 45 degrees
  rules.in("", "attitude: roll [rad]", machine.attitude.roll, -steepest, steepest);
  rules.in("", "attitude: pitch [rad]", machine.attitude.pitch, -steepest, steepest);
  if (machine.tail_radius) rules.positive("", "tail_radius", *machine.tail_radius, longest_part);
  if (machine.track_width) rules.positive("", "track_width", *machine.track_width, longest_part);
  for (const Joint joint : {Joint::boom, Joint::arm, Joint::bucket}) {
    const auto i = static_cast<std::size_t>(joint);
    check_joint(rules, joint, machine.limits[i], machine.links[i]);
  }
  check_bucket(rules, machine);
  check_hydraulics(rules, machine);
  check_rest(rules, machine);
}

}  // namespace excavplan
