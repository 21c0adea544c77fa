// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/machine_reading.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "machine/machine_check.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr std::array<Joint, 3> all_joints = {Joint::boom, Joint::arm, Joint::bucket};

double positive(JsonObject& object, const std::string& key, double highest) {
  const double value = object.number(key);
  if (value <= 0.0 || value > highest) {
    object.fail(
        key, "is " + number_text(value) + ", must be above 0 and at most " + number_text(highest));
  }
  return value;
}

void read_geometry(JsonObject file, Machine& machine) {
  const std::vector<double> pin = file.numbers("boom_pin_m", 2);
  if (std::max(std::abs(pin[0]), std::abs(pin[1])) > longest_part) {
    file.fail("boom_pin_m", "is further than " + number_text(longest_part) + " m from the origin");
  }
  machine.boom_pin = {pin[0], pin[1]};
  machine.boom_length = positive(file, "boom_length_m", longest_part);
  machine.arm_length = positive(file, "arm_length_m", longest_part);
  machine.bucket_length = positive(file, "bucket_length_m", longest_part);
  machine.track_front = file.number("track_front_m", -longest_part, longest_part);
  if (file.has("track_width_m"))
    machine.track_width = positive(file, "track_width_m", longest_part);
  if (file.has("tail_radius_m"))
    machine.tail_radius = positive(file, "tail_radius_m", longest_part);
  file.ignore("sources");
  file.done();
}

JointLimits read_limits(JsonObject file, Joint joint) {
  const double lowest = joint == Joint::arm ? 0.0 : -pi;
  JointLimits limits;
  limits.lower = file.number("lower_rad", lowest, pi);
  limits.upper = file.number("upper_rad", lowest, pi);
  if (limits.upper <= limits.lower) {
    file.fail("upper_rad", "is " + number_text(limits.upper) +
                               ", must be above lower_rad = " + number_text(limits.lower));
  }
  limits.speed = positive(file, "speed_rad_per_s", 100.0);
  limits.acceleration = positive(file, "acceleration_rad_per_s2", 1e4);
  limits.torque = positive(file, "torque_n_m", 1e9);
  file.done();
  return limits;
}

LinkMass read_link(JsonObject file) {
  LinkMass link;
  link.mass = positive(file, "mass_kg", 1e6);
  link.along = file.number("center_along_m", -longest_part, longest_part);
  link.across = file.number("center_across_m", -longest_part, longest_part);
  file.done();
  return link;
}

std::vector<Vector2d> read_profile(JsonObject& file) {
  std::vector<Vector2d> profile;
  for (JsonObject& corner : file.objects("profile")) {
    const double along = corner.number("along_m", -longest_part, longest_part);
    profile.emplace_back(along, corner.number("across_m", -longest_part, longest_part));
    corner.done();
  }
  return profile;
}

Teeth read_teeth(JsonObject file) {
  Teeth teeth;
  const double count = file.number("count");
  if (!(count >= 1.0 && count <= 50.0 && count == std::floor(count))) {
    file.fail("count", "is " + number_text(count) + ", must be a whole number in 1 .. 50");
  }
  teeth.count = static_cast<int>(count);
  teeth.width = positive(file, "width_m", longest_part);
  teeth.thickness = positive(file, "thickness_m", 1.0);
  teeth.length = positive(file, "length_m", 1.0);
  teeth.angle = file.number("angle_rad");
  if (!(teeth.angle > 0.0 && teeth.angle < pi / 2.0)) {
    file.fail("angle_rad", "is " + number_text(teeth.angle) + ", must be above 0 and below " +
                               number_text(pi / 2.0));
  }
  file.ignore("sources");
  file.done();
  return teeth;
}

Bucket read_bucket(JsonObject file, double bucket_length, double boom_length) {
  Bucket bucket;
  bucket.profile = read_profile(file);
  bucket.width_outside = positive(file, "width_outside_m", longest_part);
  bucket.width_inside = positive(file, "width_inside_m", longest_part);
  bucket.edge_thickness = positive(file, "edge_thickness_m", 1.0);
  bucket.edge_angle = positive(file, "edge_angle_rad", pi / 2.0);
  if (file.has("teeth")) bucket.teeth = read_teeth(file.object("teeth"));
  check_shape(bucket, bucket_length, boom_length,
              [&](const char* key, const std::string& what) { file.fail(key, what); });
  file.ignore("sources");
  file.done();
  return bucket;
}

PolarPin read_pin(JsonObject& file) {
  PolarPin pin;
  pin.distance = positive(file, "distance_m", longest_part);
  pin.angle = file.number("angle_rad", -pi, pi);
  file.ignore("sources");
  return pin;
}

PolarPin read_lone_pin(JsonObject file) {
  const PolarPin pin = read_pin(file);
  file.done();
  return pin;
}

Bar read_bar(JsonObject file) {
  Bar bar;
  bar.pin = read_pin(file);
  bar.length = positive(file, "length_m", longest_part);
  file.done();
  return bar;
}

int read_count(JsonObject& file) {
  const double count = file.number("count");
  if (count != 1.0 && count != 2.0) {
    file.fail("count", "is " + number_text(count) + ", must be 1 or 2");
  }
  return static_cast<int>(count);
}

CylinderGeometry read_cylinder(JsonObject file) {
  CylinderGeometry geometry;
  geometry.count = read_count(file);
  geometry.foot = read_lone_pin(file.object("foot"));
  if (file.has("rocker") || file.has("link")) {
    geometry.rod = FourBar{read_bar(file.object("rocker")), read_bar(file.object("link"))};
  } else {
    geometry.rod = read_lone_pin(file.object("rod"));
  }
  file.ignore("sources");
  file.done();
  return geometry;
}

Piston read_piston(JsonObject file) {
  Piston piston;
  piston.diameter = positive(file, "piston_diameter_m", 1.0);
  piston.rod_diameter = positive(file, "rod_diameter_m", 1.0);
  if (piston.rod_diameter >= piston.diameter) {
    file.fail("rod_diameter_m",
              "is " + number_text(piston.rod_diameter) +
                  ", must be below piston_diameter_m = " + number_text(piston.diameter));
  }
  if (file.has("speed_m_per_s")) piston.speed = positive(file, "speed_m_per_s", 100.0);
  file.done();
  return piston;
}

Hydraulics read_hydraulics(JsonObject file) {
  Hydraulics hydraulics;
  hydraulics.pump_flow = positive(file, "pump_flow_m3_per_s", 1.0);
  for (std::size_t i = 0; i < all_joints.size(); ++i) {
    hydraulics.pistons[i] = read_piston(file.object(name(all_joints[i])));
  }
  file.ignore("sources");
  file.done();
  return hydraulics;
}

void read_cylinders(JsonObject file, Machine& machine) {
  const auto cylinder = [&](std::size_t i) {
    const char* key = name(all_joints[i]);
    const JointLimits& limits = machine.limits[i];
    try {
      return Cylinder(read_cylinder(file.object(key)), limits.lower, limits.upper);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::bad_file) throw;
      file.fail(key, error.what());
    }
  };
  machine.cylinders = Cylinders{cylinder(0), cylinder(1), cylinder(2)};
  if (file.has("hydraulics")) machine.hydraulics = read_hydraulics(file.object("hydraulics"));
  file.done();
}

Body read_body(JsonObject file, double track_front) {
  Body body;
  body.mass = positive(file, "mass_kg", 1e6);
  const std::vector<double> centre = file.numbers("center_m", 2);
  body.centre = {centre[0], centre[1]};
  if (!(centre[1] > 0.0 && centre[1] <= longest_part)) {
    file.fail("center_m", "has its z at " + number_text(centre[1]) +
                              ", must be above 0 and at most " + number_text(longest_part));
  }
  body.rear_edge = file.number("rear_edge_m", -longest_part, longest_part);
  body.front_edge = file.number("front_edge_m", -longest_part, track_front);
  if (!(body.rear_edge < centre[0] && centre[0] < body.front_edge)) {
    file.fail("center_m", "has its x at " + number_text(centre[0]) +
                              ", must lie between rear_edge_m = " + number_text(body.rear_edge) +
                              " and front_edge_m = " + number_text(body.front_edge));
  }
  body.track_friction = positive(file, "track_friction", 2.0);
  file.ignore("sources");
  file.done();
  return body;
}

Swing read_swing(JsonObject file) {
  Swing swing;
  swing.speed = positive(file, "speed_rad_per_s", 100.0);
  swing.torque = positive(file, "torque_n_m", 1e9);
  swing.inertia = positive(file, "inertia_kg_m2", 1e9);
  if (file.has("acceleration_rad_per_s2")) {
    swing.acceleration = positive(file, "acceleration_rad_per_s2", 1e4);
  }
  if (file.has("lower_rad") || file.has("upper_rad")) {
    swing.lower = file.number("lower_rad", -widest_swing_range, widest_swing_range);
    swing.upper = file.number("upper_rad", -widest_swing_range, widest_swing_range);
    if (swing.upper <= swing.lower) {
      file.fail("upper_rad", "is " + number_text(swing.upper) +
                                 ", must be above lower_rad = " + number_text(swing.lower));
    }
  }
  file.ignore("sources");
  file.done();
  return swing;
}

Eigen::Isometry3d read_root(JsonObject file) {
  const std::vector<double> at = file.numbers("position_m", 3);
  for (const double number : at) {
    if (std::abs(number) > longest_part) {
      file.fail("position_m",
                "is further than " + number_text(longest_part) + " m from the origin");
    }
  }
  Eigen::Isometry3d site_from_root = Eigen::Isometry3d::Identity();
  site_from_root.translation() = Eigen::Vector3d(at[0], at[1], at[2]);
  site_from_root.rotate(
      Eigen::AngleAxisd(file.number_or("yaw_rad", 0.0, -pi, pi), Eigen::Vector3d::UnitZ()));
  file.ignore("sources");
  file.done();
  return site_from_root;
}

Engine read_engine(JsonObject file) {
  Engine engine;
  engine.power = positive(file, "power_w", 1e8);
  engine.idle_power = file.number("idle_power_w", 0.0, 1e8);
  file.ignore("sources");
  file.done();
  return engine;
}

}  // namespace

Machine read_machine(JsonObject file) {
  Machine machine;
  machine.name = file.text("name");
  for (const char* key : {"description", "data_sheet"}) file.ignore(key);
  read_geometry(file.object("geometry"), machine);
  JsonObject joints = file.object("joints");
  JsonObject links = file.object("links");
  for (std::size_t i = 0; i < all_joints.size(); ++i) {
    const char* key = name(all_joints[i]);
    machine.limits[i] = read_limits(joints.object(key), all_joints[i]);
    machine.links[i] = read_link(links.object(key));
  }
  machine.bucket = read_bucket(file.object("bucket"), machine.bucket_length, machine.boom_length);
  if (file.has("cylinders")) read_cylinders(file.object("cylinders"), machine);
  if (file.has("body")) machine.body = read_body(file.object("body"), machine.track_front);
  if (file.has("swing")) machine.swing = read_swing(file.object("swing"));
  if (file.has("engine")) machine.engine = read_engine(file.object("engine"));
  if (file.has("robot_root")) machine.site_from_root = read_root(file.object("robot_root"));
  if (file.has("robot_joints")) {
    JsonObject robot = file.object("robot_joints");
    machine.robot_joints = read_robot_joints(robot);
    for (std::size_t i = 0; i < all_joints.size(); ++i) {
      if (!machine.robot_joints[i].name.empty()) continue;
      robot.fail(std::string(name(all_joints[i])) + ".name",
                 "is empty; boom, arm and bucket must have a name");
    }
  }
  for (JsonObject* object : {&joints, &links, &file}) {
    object->ignore("sources");
    object->done();
  }
  check_units(machine,
              [&](const std::string& key, const std::string& what) { file.fail(key, what); });
  return machine;
}

}  // namespace excavplan
