// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

// motion_beside_kdl [MOVES]: random moves of all joints from rest to rest, as a motion of ours and
// along the trapezoid of Orocos KDL (liborocos-kdl-dev), both at 100 Hz: durations, and what
// controllers that interpolate make of the points.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <kdl/velocityprofile_trap.hpp>

#include <excavplan/base/data_files.hpp>

#include "support/motion_check.hpp"

namespace {

using namespace excavplan;
using namespace excavplan::test;

/// A machine whose joints alone have limits.
Machine plain_machine() {
  Machine machine = load_machine(find_data_file("machines/zx120.json"));
  machine.hydraulics.reset();
  machine.engine.reset();
  machine.swing->acceleration = 0.35;
  machine.swing->torque = 1e9;
  return machine;
}

Way any_move(const Machine& machine, Random& random) {
  Way way;
  for (int pose = 0; pose < 2; ++pose) {
    FrontJoints joints;
    for (int i = 0; i < 3; ++i) {
      const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
      joints[i] = random.uniform(limits.lower, limits.upper);
    }
    joints[3] = random.uniform(-2.0, 2.0);
    way.poses.push_back({DigPhase::approach, joints, JointAngles::Zero()});
  }
  return way;
}

/// The fastest trapezoid of the share of the move, sampled.
Trajectory by_kdl(const Machine& machine, const Way& way, double step) {
  const FrontJoints from = way.poses[0].joints, move = way.poses[1].joints - from;
  double speed = machine.swing->speed / std::abs(move[3]);
  double acceleration = machine.swing->acceleration / std::abs(move[3]);
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    speed = std::min(speed, limits.speed / std::abs(move[i]));
    acceleration = std::min(acceleration, limits.acceleration / std::abs(move[i]));
  }
  KDL::VelocityProfile_Trap profile(speed, acceleration);
  profile.SetProfile(0.0, 1.0);
  Trajectory motion;
  for (int k = 0;; ++k) {
    const double time = std::min(k * step, profile.Duration());
    const FrontJoints joints = from + profile.Pos(time) * move;
    const FrontJoints rates = profile.Vel(time) * move, bends = profile.Acc(time) * move;
    TrajectoryPoint point;
    point.time = time;
    point.joints = joints.head<3>();
    point.rates = rates.head<3>();
    point.accelerations = bends.head<3>();
    point.swing = {joints[3], rates[3], bends[3]};
    motion.points.push_back(point);
    if (time >= profile.Duration()) return motion;
  }
}

struct Figures {
  double duration = 0.0, cubic = 0.0, quintic = 0.0;

  void add(const MotionCase& made, const Trajectory& motion) {
    duration += motion.duration();
    cubic = std::max(cubic, used_between(made, motion, test::cubic).most());
    quintic = std::max(quintic, used_between(made, motion, test::quintic).most());
  }
  void print(const char* of_what) const {
    std::printf("%-22s %12.3f %22.6f %22.6f\n", of_what, duration, cubic, quintic);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const int moves = argc > 1 ? std::atoi(argv[1]) : 1000;
  const Machine machine = plain_machine();
  Figures kdl, ours, smooth;
  std::vector<double> ratios;
  for (int i = 0; i < moves; ++i) {
    Random random(17, static_cast<std::uint64_t>(i));
    MotionCase made{machine, any_move(machine, random), {}, JointAngles::Zero(), {}};
    made.options.speed_fraction = 1.0;
    const Trajectory theirs = by_kdl(machine, made.way, 1.0 / made.options.rate);
    const Trajectory motion = time_way(machine, made.way, made.options);
    kdl.add(made, theirs);
    ours.add(made, motion);
    ratios.push_back(motion.duration() / theirs.duration());
    made.options.max_jerk = 10.0;
    smooth.add(made, time_way(machine, made.way, made.options));
  }
  std::sort(ratios.begin(), ratios.end());
  for (Figures* each : {&kdl, &ours, &smooth}) each->duration /= moves;
  std::printf("%-22s %12s %22s %22s\n", "", "duration [s]", "limit, through cubics",
              "limit, through quintics");
  kdl.print("KDL, trapezoid");
  ours.print("excavplan");
  smooth.print("excavplan, 10 rad/s^3");
  std::printf("duration of excavplan over KDL's: median %.4f, %.4f .. %.4f\n",
              ratios[ratios.size() / 2], ratios.front(), ratios.back());
}
