// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_cycle.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <excavplan/error.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "machine/plane.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr int steps = 16;  // of a movement to one pose; ours
// Fall of the bucket's floor towards the tip once it is open, steeper than soil stands; ours.
constexpr double open_floor = 0.25 * pi;

/// Centre of the bucket's cavity in the bucket frame, where the payload is taken to be.
Vector2d cavity_centre(const Bucket& bucket) {
  const std::vector<Vector2d>& corners = bucket.profile;
  Vector2d sum = Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& next = corners[(i + 1) % corners.size()];
    const double twice = cross(corners[i], next);
    sum += twice / 3.0 * (corners[i] + next);
    area += twice;
  }
  return sum / area;
}

/// Boom, arm and bucket with what is in it.
struct Front {
  const Machine& machine;
  double payload = 0.0;  ///< [kg]
  Vector2d centre = cavity_centre(machine.bucket);

  JointAngles torque(const JointAngles& joints) const {
    const LinkPositions at = link_positions(machine, joints);
    return torque_against_link_weight(machine, at) +
           torque_against_force(machine, at, bucket_point(at, centre), {0.0, -payload * gravity});
  }

  /// About the swing axis, with the upper structure: links and payload as points [kg m^2].
  double inertia(const JointAngles& joints) const {
    const LinkPositions at = link_positions(machine, joints);
    const double pins[] = {machine.boom_pin.x(), at.arm_pin.x(), at.bucket_pin.x()};
    const double angles[] = {at.phi1, at.phi2, at.phi3};
    double sum = machine.swing->inertia + payload * std::pow(bucket_point(at, centre).x(), 2);
    for (std::size_t i = 0; i < machine.links.size(); ++i) {
      const LinkMass& link = machine.links[i];
      const double x =
          pins[i] + link.along * std::cos(angles[i]) - link.across * std::sin(angles[i]);
      sum += link.mass * x * x;
    }
    return sum;
  }
};

using Way = std::vector<DigPose>;

/// Goes on to another pose, all joints at once.
void go(Way& way, const JointAngles& to) {
  const JointAngles from = way.back().joints;
  for (int i = 1; i <= steps; ++i) {
    way.push_back(way.back());
    way.back().joints = from + static_cast<double>(i) / steps * (to - from);
  }
}

Trajectory timed(const Machine& machine, const Way& way) {
  DigPath path;
  path.poses = way;
  for (DigPose& pose : path.poses) pose.phase = DigPhase::lift;
  return time_dig_path(machine, path);
}

/// Positive work of the joints, and the time that it takes.
CycleShare move(const Front& front, const Way& way, const Trajectory& trajectory) {
  double work = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const JointAngles turn = way[i].joints - way[i - 1].joints;
    const JointAngles torque = front.torque(0.5 * (way[i].joints + way[i - 1].joints));
    work += (torque.array() * turn.array()).max(0.0).sum();
  }
  return {work, std::max(trajectory.duration(), work / front.machine.engine->power)};
}

/// To another pose and there at rest.
CycleShare move(const Front& front, const JointAngles& from, const JointAngles& to) {
  Way way(1);
  way.front().joints = from;
  go(way, to);
  return move(front, way, timed(front.machine, way));
}

/// By a trapezoid of the rate; braking costs nothing and gives nothing back.
CycleShare swing_by(const Swing& swing, double inertia, double angle) {
  const double acceleration = swing.torque / inertia;
  const double rate = std::min(swing.speed, std::sqrt(angle * acceleration));
  if (rate == 0.0) return {};
  return {0.5 * inertia * rate * rate, angle / rate + rate / acceleration};
}

/// The scoop's last pose and those of the lift.
Way lift_of(const DigPath& path) {
  auto begin = std::find_if(path.poses.begin(), path.poses.end(),
                            [](const DigPose& pose) { return pose.phase == DigPhase::lift; });
  if (begin != path.poses.begin()) --begin;
  return {begin, path.poses.end()};
}

/// Of a path from elsewhere a joint may lie beyond its limits: then the lower bound counts.
double within(double value, double lowest, double highest) {
  return std::max(std::min(value, highest), lowest);
}

double pin_height(const Machine& machine, const JointAngles& joints) {
  return link_positions(machine, joints).bucket_pin.y();
}

/// From a pose the boom, and where that does not suffice the arm, raise the bucket pin; the bucket
/// keeps its attitude as far as its joint can.
JointAngles raised(const Machine& machine, const JointAngles& from, double height) {
  const JointLimits& boom = machine.limits[0];
  const JointLimits& arm = machine.limits[1];
  const double rise = height - machine.boom_pin.y();
  JointAngles to = from;
  const Vector2d pin = machine.boom_length * Vector2d(1.0, 0.0) +
                       machine.arm_length * direction(-from[1]);  // with the boom level
  const double sine = within(rise / pin.norm(), -1.0, 1.0);
  to[0] = within(std::atan2(pin.y(), pin.x()) - std::asin(sine), boom.lower, boom.upper);
  if (pin_height(machine, to) < height - 1e-9) {
    const double of_arm = (rise + machine.boom_length * std::sin(to[0])) / machine.arm_length;
    to[1] = within(-to[0] - std::asin(within(of_arm, -1.0, 1.0)), arm.lower, from[1]);
  }
  to[2] = within(from.sum() - to[0] - to[1], machine.limits[2].lower, machine.limits[2].upper);
  return to;
}

JointAngles opened(const Machine& machine, JointAngles joints) {
  const double attitude = open_floor - pi + machine.beta();
  joints[2] = within(-joints[0] - joints[1] - attitude, machine.limits[2].lower, joints[2]);
  return joints;
}

void check(const DigPath& path, const PlannedDig& dig, const CycleOptions& options) {
  constexpr double most = 1e9;  // as DigObjective's
  if (path.poses.empty()) refuse("cycle: the path has no pose");
  require_in("cycle: payload_mass of the dig [kg]", dig.payload_mass, 0.0, most);
  require_in("cycle: energy of the dig [J]", dig.energy, 0.0, 1e3 * most);
  require_in("cycle: duration of the dig [s]", dig.duration, 0.0, most);
  require_in("cycle: swing [rad]", options.swing, 0.0, 2.0 * pi);
  require_in("cycle: dump_height [m]", options.dump_height, 0.0, most);
  require_in("cycle: rest_of_cycle [s]", options.rest_of_cycle, 0.0, most);
}

}  // namespace

std::optional<DigCycle> cycle_of(const Machine& machine, const DigPath& path, const PlannedDig& dig,
                                 const CycleOptions& options) {
  require_machine(machine);
  if (!machine.swing || !machine.engine) return std::nullopt;
  check(path, dig, options);
  const Front loaded{machine, dig.payload_mass}, empty{machine};
  Way lift = lift_of(path);
  const JointAngles clear = lift.back().joints;
  const double height = std::max(options.dump_height, pin_height(machine, clear));
  go(lift, raised(machine, clear, height));
  const JointAngles full = lift.back().joints, open = opened(machine, full);
  const Trajectory up = timed(machine, lift);
  const auto is_clear = std::find_if(up.points.begin(), up.points.end(), [&](const auto& point) {
    return (point.joints - clear).norm() < 1e-6;
  });
  const double clear_at = is_clear != up.points.end() ? is_clear->time : up.duration();

  DigCycle cycle;
  cycle.dig = {dig.energy, dig.duration};
  cycle.lift = move(loaded, lift, up);
  cycle.swing = swing_by(*machine.swing, loaded.inertia(clear), options.swing);
  cycle.dump = move(empty, full, open);
  cycle.back = swing_by(*machine.swing, empty.inertia(open), options.swing);
  cycle.lower = move(empty, open, path.poses.front().joints);
  cycle.rest.time = options.rest_of_cycle;
  cycle.total.time = cycle.dig.time + std::max(cycle.lift.time, clear_at + cycle.swing.time) +
                     cycle.dump.time + std::max(cycle.back.time, cycle.lower.time) +
                     cycle.rest.time;
  cycle.rest.energy = machine.engine->idle_power * cycle.total.time;
  for (const CycleShare* part : {&cycle.dig, &cycle.lift, &cycle.swing, &cycle.dump, &cycle.back,
                                 &cycle.lower, &cycle.rest}) {
    cycle.total.energy += part->energy;
  }
  return cycle;
}

void require_cycle(const Machine& machine, const CycleOptions& options) {
  const auto refuse = [&](const std::string& text) {
    throw Error(ErrorKind::bad_input, "the cycle of machine " + machine.name + ": " + text);
  };
  const std::string swing =
      machine.swing ? "" : "swing (speed_rad_per_s, torque_n_m, inertia_kg_m2)";
  const std::string engine = machine.engine ? "" : "engine (power_w, idle_power_w)";
  if (!machine.swing || !machine.engine) {
    refuse("its file lacks " + swing + (machine.swing || machine.engine ? "" : " and ") + engine +
           "; the goal energy needs neither");
  }
  require_machine(machine);
  const double highest =
      pin_height(machine, {machine.limits[0].lower, machine.limits[1].lower, 0.0});
  if (options.dump_height <= highest) return;
  refuse("the dump height is " + number_text(options.dump_height) + " m, the bucket pin reaches " +
         readable(highest) + " m");
}

}  // namespace excavplan
