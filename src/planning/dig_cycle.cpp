// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_cycle.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/machine/trajectory.hpp>
#include <excavplan/soil/soil.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "planning/front_load.hpp"

namespace excavplan {
namespace {

constexpr int steps = 16;            // of a movement to one pose; ours
constexpr double over_ground = 0.3;  // of a loaded bucket that goes back to dig; ours [m]

using Poses = std::vector<DigPose>;

/// Goes on to another pose, all joints at once.
void go(Poses& way, const JointAngles& to) {
  const JointAngles from = way.back().joints;
  for (int i = 1; i <= steps; ++i) {
    way.push_back(way.back());
    way.back().joints = from + static_cast<double>(i) / steps * (to - from);
  }
}

Trajectory timed(const Machine& machine, const Poses& way) {
  DigPath path;
  path.poses = way;
  for (DigPose& pose : path.poses) pose.phase = DigPhase::lift;
  return time_dig_path(machine, path);
}

/// Positive work of the joints, and the time that it takes.
CycleShare move(const FrontLoad& front, const Poses& way, const Trajectory& trajectory) {
  double work = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const JointAngles turn = way[i].joints - way[i - 1].joints;
    const JointAngles torque = front.torque(0.5 * (way[i].joints + way[i - 1].joints));
    work += (torque.array() * turn.array()).max(0.0).sum();
  }
  return {work, std::max(trajectory.duration(), work / front.machine().engine->power)};
}

/// To another pose and there at rest.
CycleShare move(const FrontLoad& front, const JointAngles& from, const JointAngles& to) {
  Poses way(1);
  way.front().joints = from;
  go(way, to);
  return move(front, way, timed(front.machine(), way));
}

/// To either side, by a trapezoid of the rate; braking costs nothing and gives nothing back.
CycleShare swing_by(const Swing& swing, double inertia, double either) {
  const double angle = std::abs(either);
  const double acceleration = std::min(swing.torque / inertia, swing.acceleration);
  const double rate = std::min(swing.speed, std::sqrt(angle * acceleration));
  if (rate == 0.0) return {};
  return {0.5 * inertia * rate * rate, angle / rate + rate / acceleration};
}

/// The scoop's last pose and those of the lift.
Poses lift_of(const DigPath& path) {
  auto begin = std::find_if(path.poses.begin(), path.poses.end(),
                            [](const DigPose& pose) { return pose.phase == DigPhase::lift; });
  if (begin != path.poses.begin()) --begin;
  return {begin, path.poses.end()};
}

void check(const DigPath& path, const PlannedDig& dig, const CycleOptions& options) {
  constexpr double most = 1e9;  // as DigObjective's
  if (path.poses.empty()) refuse("cycle: the path has no pose");
  require_in("cycle: payload_mass of the dig [kg]", dig.payload_mass, 0.0, most);
  require_in("cycle: energy of the dig [J]", dig.energy, 0.0, 1e3 * most);
  require_in("cycle: duration of the dig [s]", dig.duration, 0.0, most);
  require_in("cycle: swing [rad]", options.swing, -2.0 * pi, 2.0 * pi);
  require_in("cycle: dump_height [m]", options.dump_height, 0.0, most);
  require_in("cycle: rest_of_cycle [s]", options.rest_of_cycle, 0.0, most);
  require_in("cycle: carried [kg]", options.carried, 0.0, most);
}

/// To lift what the bucket holds already along with the dig, at least.
double work_on(double carried, const Machine& machine, const DigPath& path, const Poses& lift) {
  const double rise =
      pin_height(machine, lift.front().joints) - pin_height(machine, path.poses.front().joints);
  return carried * gravity * std::max(0.0, rise);
}

}  // namespace

std::optional<DigCycle> cycle_of(const Machine& machine, const DigPath& path, const PlannedDig& dig,
                                 const CycleOptions& options) {
  require_machine(machine);
  if (!machine.swing || !machine.engine) return std::nullopt;
  check(path, dig, options);
  const FrontLoad loaded(machine, options.carried + dig.payload_mass), empty(machine);
  Poses lift = lift_of(path);
  const double carrying = work_on(options.carried, machine, path, lift);
  const JointAngles clear = lift.back().joints;
  const double clear_height = pin_height(machine, clear);
  const double height =
      options.keeps_load ? clear_height + over_ground : std::max(options.dump_height, clear_height);
  go(lift, raised(machine, clear, height));
  const JointAngles full = lift.back().joints, open = opened(machine, full);
  const Trajectory up = timed(machine, lift);
  const auto is_clear = std::find_if(up.points.begin(), up.points.end(), [&](const auto& point) {
    return (point.joints - clear).norm() < 1e-6;
  });
  const double clear_at = is_clear != up.points.end() ? is_clear->time : up.duration();

  DigCycle cycle;
  cycle.dig = {dig.energy + carrying, dig.duration};
  cycle.lift = move(loaded, lift, up);
  if (options.keeps_load) {
    cycle.lower = move(loaded, full, path.poses.front().joints);
  } else {
    cycle.swing = swing_by(*machine.swing, loaded.inertia(clear), options.swing);
    cycle.dump = move(empty, full, open);
    cycle.back = swing_by(*machine.swing, empty.inertia(open), options.swing);
    cycle.lower = move(empty, open, path.poses.front().joints);
  }
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

std::optional<CycleShare> dump_of(const Machine& machine, const JointAngles& held,
                                  const CycleOptions& options) {
  DigPath still;
  still.poses.resize(1);
  still.poses.front().joints = held;
  const auto cycle = cycle_of(machine, still, {}, options);
  return cycle ? std::optional<CycleShare>(cycle->total) : std::nullopt;
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
