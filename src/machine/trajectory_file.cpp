// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>
#include <utility>

#include <excavplan/machine/trajectory.hpp>

#include "base/json.hpp"
#include "base/text.hpp"
#include "machine/machine_reading.hpp"
#include "machine/plan_stamp.hpp"

namespace excavplan {
namespace {

constexpr const char* format = "excavplan-trajectory";

bool states_cylinders(const Trajectory& trajectory) {
  return !trajectory.points.empty() && trajectory.points.front().cylinders.allFinite();
}

/// As time_way() does.
bool states_accelerations(const Trajectory& trajectory) {
  return !trajectory.points.empty() && trajectory.points.front().accelerations.allFinite();
}

void append(std::string& csv, const Eigen::Vector3d& values) {
  for (const double value : values) csv += ',' + number_text(value);
}

nlohmann::ordered_json list(const Eigen::Vector3d& values) {
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d read_vector(JsonObject& object, const std::string& key) {
  const std::vector<double> values = object.numbers(key, 3);
  return {values[0], values[1], values[2]};
}

DigPhase read_phase(JsonObject& object) {
  const std::string text = object.text("phase");
  for (const DigPhase phase :
       {DigPhase::approach, DigPhase::penetrate, DigPhase::drag, DigPhase::scoop, DigPhase::lift,
        DigPhase::swing, DigPhase::dump, DigPhase::back}) {
    if (text == name(phase)) return phase;
  }
  object.fail("phase", "is " + in_quotes(text) +
                           ", must be approach, penetrate, drag, scoop, lift, swing, dump or back");
}

/// What the points of a file state.
struct Stated {
  bool cylinders = false;
  bool accelerations = false;
};

TrajectoryPoint read_point(JsonObject object, const Stated& stated) {
  TrajectoryPoint point;
  point.time = object.number("time_s", 0.0);
  point.phase = read_phase(object);
  point.joints = read_vector(object, "joints_rad");
  point.rates = read_vector(object, "rates_rad_per_s");
  const std::vector<double> tip = object.numbers("tip_m", 2);
  point.bucket = {tip[0], tip[1], object.number("bucket_angle_rad")};
  if (stated.cylinders) {
    point.cylinders = read_vector(object, "cylinders_m");
    point.cylinder_speeds = read_vector(object, "cylinder_speeds_m_per_s");
  }
  if (stated.accelerations) {
    point.accelerations = read_vector(object, "accelerations_rad_per_s2");
    point.swing = {object.number("swing_rad"), object.number("swing_rad_per_s"),
                   object.number("swing_rad_per_s2")};
  }
  object.done();
  return point;
}

/// Points are in the order of time, from 0 on, and of the phases.
void check_order(const JsonObject& file, const std::vector<TrajectoryPoint>& points) {
  if (points.empty()) file.fail("points", "holds no point");
  if (points.front().time != 0.0) {
    file.fail("points", "begins at time_s = " + number_text(points.front().time) + ", must be 0");
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::string which = "point " + std::to_string(i + 1);
    if (!(points[i].time > points[i - 1].time)) {
      file.fail("points", "time_s must rise, " + which + " does not");
    }
    if (points[i].phase < points[i - 1].phase) {
      file.fail("points",
                "phases must be in order, " + which + " goes back to " + name(points[i].phase));
    }
  }
}

}  // namespace

std::string to_csv(const Trajectory& trajectory) {
  const bool with_cylinders = states_cylinders(trajectory);
  const bool with_accelerations = states_accelerations(trajectory);
  std::string csv =
      "time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad,"
      "boom_rad_per_s,arm_rad_per_s,bucket_rad_per_s";
  if (with_cylinders) {
    csv +=
        ",boom_cylinder_m,arm_cylinder_m,bucket_cylinder_m,"
        "boom_cylinder_m_per_s,arm_cylinder_m_per_s,bucket_cylinder_m_per_s";
  }
  if (with_accelerations) {
    csv +=
        ",boom_rad_per_s2,arm_rad_per_s2,bucket_rad_per_s2,"
        "swing_rad,swing_rad_per_s,swing_rad_per_s2";
  }
  csv += '\n';
  for (const TrajectoryPoint& point : trajectory.points) {
    csv += number_text(point.time) + ',' + name(point.phase);
    append(csv, point.joints);
    append(csv, {point.bucket.x, point.bucket.z, point.bucket.floor_angle});
    append(csv, point.rates);
    if (with_cylinders) {
      append(csv, point.cylinders);
      append(csv, point.cylinder_speeds);
    }
    if (with_accelerations) {
      append(csv, point.accelerations);
      append(csv, {point.swing.angle, point.swing.rate, point.swing.acceleration});
    }
    csv += '\n';
  }
  return csv;
}

std::string to_json(const Trajectory& trajectory) {
  const bool with_cylinders = states_cylinders(trajectory);
  const bool with_accelerations = states_accelerations(trajectory);
  const nlohmann::ordered_json joints = robot_joints_json(trajectory.robot_joints);
  require_storable({{"machine", trajectory.machine}, {"robot_joints", joints}}, "trajectory");
  std::string json = "{\n \"format\": \"" + std::string(format) +
                     "\",\n \"version\": 1,\n \"machine\": " + json_text(trajectory.machine) +
                     ",\n \"robot_joints\": " + json_text(joints);
  if (trajectory.plan) {
    const nlohmann::ordered_json stamp = stamp_json(*trajectory.plan);
    require_storable(stamp, "trajectory: plan");
    json += ",\n \"plan\": " + json_text(stamp);
  }
  json += ",\n \"points\": [";
  const char* separator = "\n  ";
  for (const TrajectoryPoint& point : trajectory.points) {
    nlohmann::ordered_json object = {{"time_s", point.time},
                                     {"phase", name(point.phase)},
                                     {"joints_rad", list(point.joints)},
                                     {"rates_rad_per_s", list(point.rates)},
                                     {"tip_m", {point.bucket.x, point.bucket.z}},
                                     {"bucket_angle_rad", point.bucket.floor_angle}};
    if (with_cylinders) {
      object["cylinders_m"] = list(point.cylinders);
      object["cylinder_speeds_m_per_s"] = list(point.cylinder_speeds);
    }
    if (with_accelerations) {
      object["accelerations_rad_per_s2"] = list(point.accelerations);
      object["swing_rad"] = point.swing.angle;
      object["swing_rad_per_s"] = point.swing.rate;
      object["swing_rad_per_s2"] = point.swing.acceleration;
    }
    require_storable(object, "trajectory");
    json += std::exchange(separator, ",\n  ") + json_text(object);
  }
  return json + "\n ]\n}\n";
}

Trajectory load_trajectory(const std::string& path) {
  JsonObject file = JsonObject::open(path, format);
  Trajectory trajectory;
  trajectory.machine = file.text("machine");
  if (file.has("robot_joints")) {
    trajectory.robot_joints = read_robot_joints(file.object("robot_joints"));
  }
  if (file.has("plan")) trajectory.plan = read_stamp(file.object("plan"));
  std::vector<JsonObject> points = file.objects("points");
  Stated stated;
  if (!points.empty()) {
    stated.cylinders = points.front().has("cylinders_m");
    stated.accelerations = points.front().has("accelerations_rad_per_s2");
  }
  trajectory.points.reserve(points.size());
  for (JsonObject& point : points) {
    trajectory.points.push_back(read_point(std::move(point), stated));
  }
  check_order(file, trajectory.points);
  file.done();
  return trajectory;
}

}  // namespace excavplan
