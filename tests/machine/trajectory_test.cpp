// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/trajectory.hpp>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/data_files.hpp>
#include "base/random.hpp"

#include "support/cases.hpp"
#include "support/errors.hpp"
#include "support/machine_file.hpp"
#include "support/run_program.hpp"

namespace excavplan {
namespace {

using test::zx120;

constexpr double tolerance = 1e-6;  // of a limit, for rounding in differences of small steps

double flat_ground_at(double) { return 0.0; }

DigPath fixed_path(double step = 0.025) {
  DigPathOptions options;
  options.step = step;
  return std::get<DigPath>(
      make_dig_path(zx120(), paper_fixed_path(), 6.0, flat_ground_at, options));
}

DigPath path_through(const std::vector<JointAngles>& joints) {
  DigPath path;
  for (const JointAngles& angles : joints) {
    path.poses.push_back({DigPhase::scoop, forward_kinematics(zx120(), angles), angles});
  }
  return path;
}

/// Largest shares of the limits that the points use.
struct Used {
  double speed = 0.0, acceleration = 0.0, cylinder_speed = 0.0, flow = 0.0, power = 0.0;
};

/// As many as there are stretches of the path.
std::vector<JointAngles> throughout(const DigPath& path, const JointAngles& torque) {
  return std::vector<JointAngles>(path.poses.size() - 1, torque);
}

/// Of joints: as differences of the points and as the stated rates, with standstill before and
/// after.
void use_joints(const Machine& machine, const Trajectory& trajectory, Used& used) {
  const auto& points = trajectory.points;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
    double mean_before = 0.0, step_before = 0.0;
    for (std::size_t k = 1; k <= points.size(); ++k) {
      const bool over = k == points.size();
      const double step = over ? 0.0 : points[k].time - points[k - 1].time;
      const double mean = over ? 0.0 : (points[k].joints[i] - points[k - 1].joints[i]) / step;
      const double change = std::abs(mean - mean_before) / (0.5 * (step + step_before));
      used.acceleration = std::max(used.acceleration, change / limits.acceleration);
      used.speed = std::max(used.speed, std::abs(mean) / limits.speed);
      mean_before = mean;
      step_before = step;
      if (over) break;
      const double rate_change = std::abs(points[k].rates[i] - points[k - 1].rates[i]) / step;
      used.acceleration = std::max(used.acceleration, rate_change / limits.acceleration);
      used.speed = std::max(used.speed, std::abs(points[k].rates[i]) / limits.speed);
    }
  }
}

/// Of the oil in one cylinder that grows this fast, its side that is filled [m^2].
double area_filled(const Machine& machine, std::size_t joint, double speed) {
  const Piston& piston = machine.hydraulics->pistons[joint];
  const double rod = speed < 0.0 ? piston.rod_diameter : 0.0;
  return 3.141592653589793 / 4.0 * (std::pow(piston.diameter, 2) - rod * rod);
}

double flow_of(const Machine& machine, const Eigen::Vector3d& speeds) {
  double flow = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double speed = speeds[static_cast<int>(i)];
    flow += (*machine.cylinders)[i].count() * area_filled(machine, i, speed) * std::abs(speed);
  }
  return flow;
}

/// Highest pressure of the cylinders that drive the joints by `move` against `torque` [Pa].
double pressure_of(const Machine& machine, const JointAngles& joints, const JointAngles& move,
                   const JointAngles& torque) {
  double highest = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(move[i]) < 1e-12 || torque[i] * move[i] <= 0.0) continue;
    const auto joint = static_cast<std::size_t>(i);
    const double lever = (*machine.cylinders)[joint].at(joints[i]).lever;
    highest = std::max(highest, std::abs((*machine.cylinders)[joint].force(joints[i], torque[i])) /
                                    area_filled(machine, joint, lever * move[i]));
  }
  return highest;
}

/// Of cylinders that grow this fast.
void use_oil(const Machine& machine, const Eigen::Vector3d& speeds, Used& used) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Piston& piston = machine.hydraulics->pistons[i];
    const double speed = speeds[static_cast<int>(i)];
    used.cylinder_speed = std::max(used.cylinder_speed, std::abs(speed) / piston.speed);
  }
  used.flow = std::max(used.flow, flow_of(machine, speeds) / machine.hydraulics->pump_flow);
}

/// @param torque  of the joints all the way but the approach [N m]
Used used_of(const Machine& machine, const Trajectory& trajectory,
             const JointAngles& torque = JointAngles::Zero()) {
  Used used;
  use_joints(machine, trajectory, used);
  if (!machine.hydraulics) return used;
  Eigen::Vector3d before;
  for (std::size_t k = 0; k < trajectory.points.size(); ++k) {
    const TrajectoryPoint& point = trajectory.points[k];
    const auto states = cylinder_states(*machine.cylinders, point.joints);
    const Eigen::Vector3d lengths(states[0].length, states[1].length, states[2].length);
    const Eigen::Vector3d levers(states[0].lever, states[1].lever, states[2].lever);
    use_oil(machine, levers.cwiseProduct(point.rates), used);
    if (k > 0) {
      const TrajectoryPoint& last = trajectory.points[k - 1];
      const Eigen::Vector3d speeds = (lengths - before) / (point.time - last.time);
      use_oil(machine, speeds, used);
      if (point.phase != DigPhase::approach) {
        const JointAngles move = point.joints - last.joints;
        const double pressure = std::max(pressure_of(machine, last.joints, move, torque),
                                         pressure_of(machine, point.joints, move, torque));
        used.power =
            std::max(used.power, pressure * flow_of(machine, speeds) / machine.engine->power);
      }
    }
    before = lengths;
  }
  return used;
}

void expect_within(const Used& used, double fraction) {
  const double most = fraction * (1.0 + tolerance);
  ASSERT_LE(used.speed, most);
  ASSERT_LE(used.acceleration, most);
  ASSERT_LE(used.cylinder_speed, most);
  ASSERT_LE(used.flow, most);
  ASSERT_LE(used.power, most);
}

void expect_well_formed(const Trajectory& trajectory) {
  const auto& points = trajectory.points;
  ASSERT_EQ(points.front().time, 0.0);
  ASSERT_EQ(points.front().rates.norm(), 0.0);
  ASSERT_EQ(points.back().rates.norm(), 0.0);
  for (std::size_t k = 1; k < points.size(); ++k) {
    ASSERT_TRUE(std::isfinite(points[k].time));
    ASSERT_GT(points[k].time, points[k - 1].time);
    ASSERT_GE(points[k].phase, points[k - 1].phase);
  }
}

/// The rates where one phase ends and the next begins.
std::vector<JointAngles> rates_between_phases(const Trajectory& trajectory) {
  std::vector<JointAngles> rates;
  for (std::size_t k = 1; k < trajectory.points.size(); ++k) {
    const TrajectoryPoint& before = trajectory.points[k - 1];
    if (trajectory.points[k].phase != before.phase) rates.push_back(before.rates);
  }
  return rates;
}

/// How far points are from the path: the tip [m], and there the attitude [rad].
class Deviation {
 public:
  Deviation(const Machine& machine, const DigPath& path)
      : machine_(machine), poses_(path.approach) {
    poses_.insert(poses_.end(), path.poses.begin(), path.poses.end());
  }

  void add(const Trajectory& trajectory) {
    std::size_t near = 1;  // the path is followed forwards: look around the last place
    for (const TrajectoryPoint& point : trajectory.points) {
      const BucketPose at = forward_kinematics(machine_, point.joints);
      double nearest = std::numeric_limits<double>::infinity(), tilt = 0.0;
      const std::size_t from = near > 4 ? near - 4 : 1;
      for (std::size_t k = from; k < std::min(poses_.size(), near + 30); ++k) {
        const auto [distance, angle] = beside(at, poses_[k - 1].bucket, poses_[k].bucket);
        if (distance >= nearest) continue;
        nearest = distance;
        tilt = angle;
        near = k;
      }
      tip_ = std::max(tip_, nearest);
      attitude_ = std::max(attitude_, tilt);
    }
  }

  double tip() const { return tip_; }
  double attitude() const { return attitude_; }

 private:
  static std::pair<double, double> beside(const BucketPose& at, const BucketPose& from,
                                          const BucketPose& to) {
    const Eigen::Vector2d step(to.x - from.x, to.z - from.z), way(at.x - from.x, at.z - from.z);
    const double share = std::clamp(way.dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double angle = from.floor_angle + share * (to.floor_angle - from.floor_angle);
    return {(way - share * step).norm(), std::abs(at.floor_angle - angle)};
  }

  const Machine& machine_;
  std::vector<DigPose> poses_;
  double tip_ = 0.0;
  double attitude_ = 0.0;
};

// ---- oracles ------------------------------------------------------------------------------------

// One joint alone is a trapezoid: full acceleration, full speed, full braking.
TEST(Trajectory, SingleJointMoveIsTheTextbookTrapezoid) {
  for (const double turn : {0.05, 0.3, 2.0}) {
    std::vector<JointAngles> joints;
    for (int i = 0; i <= 1000; ++i) joints.emplace_back(-0.3, 1.5, turn * i / 1000);
    const Trajectory trajectory = time_dig_path(zx120(), path_through(joints), {1.0});
    const double v = zx120().limits[2].speed, a = zx120().limits[2].acceleration;
    const double expected = turn > v * v / a ? turn / v + v / a : 2.0 * std::sqrt(turn / a);
    EXPECT_NEAR(trajectory.duration(), expected, 0.005 * expected);
    EXPECT_GE(trajectory.duration(), expected * (1 - 1e-9));
  }
}

TEST(Trajectory, PaperFixedPathTakesAFewSeconds) {
  const Trajectory trajectory = time_dig_path(zx120(), fixed_path(), {1.0});
  EXPECT_GT(trajectory.dig_duration(), 3.5);
  EXPECT_LT(trajectory.dig_duration(), 5.0);
  EXPECT_GT(trajectory.duration(), trajectory.dig_duration());
}

TEST(Trajectory, DurationHardlyDependsOnTheSampling) {
  const double fine = time_dig_path(zx120(), fixed_path(0.002)).dig_duration();
  EXPECT_NEAR(time_dig_path(zx120(), fixed_path(0.025)).dig_duration(), fine, 0.01 * fine);
  EXPECT_NEAR(time_dig_path(zx120(), fixed_path(0.1)).dig_duration(), fine, 0.03 * fine);
}

/// Boom, arm and bucket one after the other, a phase each, in steps of equal length.
DigPath one_joint_after_the_other(double turn, int steps) {
  JointAngles at(-0.3, 1.5, 0.5);
  std::vector<JointAngles> joints = {at};
  for (int i = 0; i < 3; ++i) {
    const double from = at[i];
    for (int k = 1; k <= steps; ++k) {
      at[i] = from + turn * k / steps;
      joints.push_back(at);
    }
  }
  DigPath path = path_through(joints);
  const DigPhase phases[] = {DigPhase::penetrate, DigPhase::drag, DigPhase::scoop};
  for (std::size_t k = 1; k < path.poses.size(); ++k) {
    path.poses[k].phase = phases[(k - 1) / static_cast<std::size_t>(steps)];
  }
  return path;
}

TEST(Trajectory, PhasesOfOneStepAreAsFastAsThoseOfManyBesideACornerToo) {
  for (const double turn : {0.01, 0.03, 0.1}) {
    for (const double off : {0.0, 1e-4, 1e-3}) {
      const TrajectoryOptions options{1.0, off};
      const double fine =
          time_dig_path(zx120(), one_joint_after_the_other(turn, 200), options).duration();
      for (const int steps : {1, 2, 3, 4}) {
        const DigPath path = one_joint_after_the_other(turn, steps);
        const Trajectory trajectory = time_dig_path(zx120(), path, options);
        expect_well_formed(trajectory);
        ASSERT_NO_FATAL_FAILURE(expect_within(used_of(zx120(), trajectory), 1.0));
        EXPECT_LT(trajectory.duration(), 1.05 * fine) << turn << " rad, " << steps << ", " << off;
        EXPECT_GT(trajectory.duration(), 0.95 * fine) << turn << " rad, " << steps << ", " << off;
      }
    }
  }
}

/// Arm, boom or bucket moved from one angle to another in many steps by a machine that is fast but
/// for its oil.
double oil_time(Joint joint, double from, double to, const std::function<void(Hydraulics&)>& set) {
  Machine machine = zx120();
  for (JointLimits& limits : machine.limits) {
    limits.speed = 50.0;
    limits.acceleration = 1e4;
  }
  set(*machine.hydraulics);
  std::vector<JointAngles> joints;
  for (int i = 0; i <= 1000; ++i) {
    joints.emplace_back(-0.3, 1.5, 0.5);
    joints.back()[static_cast<int>(joint)] = from + (to - from) * i / 1000;
  }
  return time_dig_path(machine, path_through(joints), {1.0}).duration();
}

double length_of(Joint joint, double angle) {
  return (*zx120().cylinders)[static_cast<std::size_t>(joint)].at(angle).length;
}

// Growing fills the side of the piston, shortening the side of the rod: time = volume / flow.
TEST(Trajectory, AtTheFlowOfThePumpsAMoveTakesItsVolume) {
  const double flow = 1e-3;
  const auto slow_pump = [flow](Hydraulics& oil) { oil.pump_flow = flow; };
  const double quarter_pi = 0.7853981633974483;
  const double boom_stroke = std::abs(length_of(Joint::boom, 0.2) - length_of(Joint::boom, -0.8));
  const double up = 2 * quarter_pi * 0.105 * 0.105 * boom_stroke / flow;
  const double down = 2 * quarter_pi * (0.105 * 0.105 - 0.07 * 0.07) * boom_stroke / flow;
  EXPECT_NEAR(oil_time(Joint::boom, 0.2, -0.8, slow_pump), up, 0.003 * up);
  EXPECT_NEAR(oil_time(Joint::boom, -0.8, 0.2, slow_pump), down, 0.003 * down);
  const double arm = quarter_pi * 0.115 * 0.115 *
                     std::abs(length_of(Joint::arm, 2.0) - length_of(Joint::arm, 1.0)) / flow;
  EXPECT_NEAR(oil_time(Joint::arm, 1.0, 2.0, slow_pump), arm, 0.003 * arm);
}

TEST(Trajectory, JointsThatMoveTogetherShareThePumps) {
  Machine machine = zx120();
  machine.hydraulics->pump_flow = 5e-4;
  for (JointLimits& limits : machine.limits) limits.acceleration = 1e4;
  const JointAngles from(0.0, 1.0, 0.0), to(-0.5, 1.8, 1.2);
  std::vector<JointAngles> joints;
  for (int i = 0; i <= 1000; ++i) joints.push_back(from + (to - from) * i / 1000);
  double volume = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto joint = static_cast<Joint>(i);
    const double diameter = machine.hydraulics->pistons[static_cast<std::size_t>(i)].diameter;
    volume += (i == 0 ? 2 : 1) * 0.7853981633974483 * diameter * diameter *
              (length_of(joint, to[i]) - length_of(joint, from[i]));
  }
  const double time = time_dig_path(machine, path_through(joints), {1.0}).duration();
  EXPECT_NEAR(time, volume / 5e-4, 0.003 * volume / 5e-4);
  EXPECT_NEAR(time_dig_path(machine, path_through(joints), {0.5}).duration(), 2 * time,
              0.01 * time);
}

TEST(Trajectory, AtTheSpeedOfTheCylinderAMoveTakesItsStroke) {
  const double time = std::abs(length_of(Joint::bucket, 2.0) - length_of(Joint::bucket, 0.0)) / 0.1;
  const auto slow_bucket = [](Hydraulics& oil) {
    oil.pump_flow = 1.0;
    oil.pistons[2].speed = 0.1;
  };
  EXPECT_NEAR(oil_time(Joint::bucket, 0.0, 2.0, slow_bucket), time, 0.003 * time);
  EXPECT_NEAR(oil_time(Joint::bucket, 2.0, 0.0, slow_bucket), time, 0.003 * time);
}

/// A machine that is fast but for the power of its pumps.
Machine strong_but_for_power(double power) {
  Machine machine = zx120();
  for (JointLimits& limits : machine.limits) {
    limits.speed = 50.0;
    limits.acceleration = 1e4;
  }
  machine.hydraulics->pump_flow = 1.0;
  machine.engine->power = power;
  return machine;
}

double loaded_time(const Machine& machine, const JointAngles& from, const JointAngles& to,
                   const JointAngles& torque, double fraction = 1.0) {
  std::vector<JointAngles> joints;
  for (int i = 0; i <= 1000; ++i) joints.push_back(from + (to - from) * i / 1000);
  const DigPath path = path_through(joints);
  return time_dig_path(machine, path, {fraction}, throughout(path, torque)).duration();
}

// Pressure times flow of one cylinder is torque times rate, whichever side of it is filled.
TEST(Trajectory, AtThePowerOfThePumpsOneCylinderTakesItsWork) {
  const Machine machine = strong_but_for_power(50e3);
  const JointAngles at(-0.3, 1.5, 0.5);
  for (int i = 0; i < 3; ++i) {
    const JointAngles move = JointAngles::Unit(i);
    const double time = 1e5 * 1.0 / 50e3;
    EXPECT_NEAR(loaded_time(machine, at, at + move, 1e5 * move), time, 0.005 * time);
    EXPECT_NEAR(loaded_time(machine, at + move, at, -1e5 * move), time, 0.005 * time);
    EXPECT_NEAR(loaded_time(machine, at, at + move, 1e5 * move, 0.5), 2 * time, 0.01 * time);
    const double unloaded = loaded_time(machine, at, at + move, JointAngles::Zero());
    EXPECT_LT(unloaded, 0.2 * time);
    EXPECT_EQ(loaded_time(machine, at, at + move, -1e5 * move), unloaded);  // the load drives
  }
}

// A flow of Q_max up to the pressure P / Q_max, then P / p: half the speed at twice that pressure.
TEST(Trajectory, BelowTheCornerPressureTheLoadCostsNoTime) {
  Machine machine = strong_but_for_power(50e3);
  machine.hydraulics->pump_flow = 1e-3;  // corner pressure 50 MPa
  const JointAngles from(-0.3, 1.0, 0.5), to(-0.3, 2.0, 0.5);
  const double free = loaded_time(machine, from, to, JointAngles::Zero());
  double weakest = std::numeric_limits<double>::infinity(), strongest = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double lever = std::abs((*machine.cylinders)[1].at(1.0 + 0.001 * i).lever);
    weakest = std::min(weakest, lever);
    strongest = std::max(strongest, lever);
  }
  const double corner_force = 50e6 * area_filled(machine, 1, 1.0);
  const auto time_at = [&](double torque) {
    return loaded_time(machine, from, to, JointAngles(0, torque, 0));
  };
  EXPECT_EQ(time_at(0.999 * weakest * corner_force), free);
  const double work = 2.0 * strongest * corner_force;
  EXPECT_NEAR(time_at(work), work / 50e3, 0.005 * work / 50e3);
}

// Of several cylinders the one of highest pressure decides: P dt = p_max (dV1 + dV2 + dV3).
TEST(Trajectory, JointsThatMoveTogetherShareThePowerAtTheHighestPressure) {
  const Machine machine = strong_but_for_power(50e3);
  const JointAngles from(-0.2, 1.0, 0.3), to(-0.6, 1.9, -0.2), torque(-8e4, 9e4, -2e4);
  double time = 0.0;
  const int steps = 1000;
  const JointAngles move = (to - from) / steps;
  for (int k = 0; k < steps; ++k) {
    const JointAngles a = from + k * move, b = a + move;
    Eigen::Vector3d grown;
    for (int i = 0; i < 3; ++i) grown[i] = length_of(Joint(i), b[i]) - length_of(Joint(i), a[i]);
    time += pressure_of(machine, 0.5 * (a + b), move, torque) * flow_of(machine, grown) / 50e3;
  }
  EXPECT_NEAR(loaded_time(machine, from, to, torque), time, 0.005 * time);
}

TEST(Trajectory, WithoutPressuresTheJointsShareThePowerByTheirWork) {
  Machine machine = strong_but_for_power(50e3);
  const JointAngles from(-0.2, 1.0, 0.3), to(-0.6, 1.9, 0.8);
  const JointAngles torque(-8e4, 9e4, -2e4);  // the bucket is driven by its load
  const double time = (8e4 * 0.4 + 9e4 * 0.9) / 50e3;
  machine.hydraulics.reset();
  EXPECT_NEAR(loaded_time(machine, from, to, torque), time, 0.005 * time);
  machine.cylinders.reset();
  EXPECT_NEAR(loaded_time(machine, from, to, torque), time, 0.005 * time);
  machine.engine.reset();
  EXPECT_LT(loaded_time(machine, from, to, torque), 0.2 * time);
}

TEST(Trajectory, TorquesSlowTheStretchesTheyBelongTo) {
  const Machine machine = strong_but_for_power(50e3);
  const DigPath path = one_joint_after_the_other(0.5, 100);
  for (int i = 0; i < 3; ++i) {
    std::vector<JointAngles> torques = throughout(path, JointAngles::Zero());
    for (int k = 0; k < 100; ++k) torques[static_cast<std::size_t>(100 * i + k)][i] = 1e5;
    const Trajectory trajectory = time_dig_path(machine, path, {1.0}, torques);
    const DigPhase phases[] = {DigPhase::penetrate, DigPhase::drag, DigPhase::scoop};
    double times[] = {0.0, 0.0, 0.0};
    for (std::size_t k = 1; k < trajectory.points.size(); ++k) {
      const auto phase = std::find(phases, phases + 3, trajectory.points[k].phase) - phases;
      times[phase] += trajectory.points[k].time - trajectory.points[k - 1].time;
    }
    for (int phase = 0; phase < 3; ++phase) {
      if (phase == i) {
        EXPECT_NEAR(times[phase], 1.0, 0.02);  // 1e5 N m over 0.5 rad at 50 kW
      } else {
        EXPECT_LT(times[phase], 0.2);
      }
    }
  }
}

TEST(Trajectory, RefusesTorquesThatDoNotFitThePath) {
  const DigPath path = fixed_path();
  const auto complaint = [&](const std::vector<JointAngles>& torques) {
    return test::error_of([&] { time_dig_path(zx120(), path, {}, torques); });
  };
  std::vector<JointAngles> torques = throughout(path, JointAngles(1e4, 1e4, 1e4));
  EXPECT_EQ(complaint(torques), "no error");
  torques.pop_back();  // a dig that ended early
  EXPECT_EQ(complaint(torques), "no error");
  torques[3][1] = std::nan("");
  EXPECT_EQ(complaint(torques), "torque 3 is not finite");
  const std::string poses = std::to_string(path.poses.size());
  EXPECT_EQ(complaint(std::vector<JointAngles>(path.poses.size(), JointAngles::Zero())),
            "there are " + poses + " torques between " + poses + " poses, must be fewer");
}

/// The arm curls, then the bucket: two straight lines in joint space.
DigPath two_straight_phases() {
  std::vector<JointAngles> joints;
  for (int i = 0; i <= 20; ++i) joints.emplace_back(-0.3, 1.5 + 0.01 * i, 0.5);
  for (int i = 1; i <= 20; ++i) joints.emplace_back(-0.3, 1.7, 0.5 + 0.01 * i);
  DigPath path = path_through(joints);
  for (std::size_t i = 0; i <= 20; ++i) path.poses[i].phase = DigPhase::drag;
  return path;
}

// A parabola between two tangents passes the corner at a quarter of |after - before|.
TEST(Trajectory, CornerIsRoundedByAParabolaThatLeavesThePathByTheTolerance) {
  const JointAngles corner(-0.3, 1.7, 0.5);
  const JointAngles turn(0.0, -1.0, 1.0);
  const LinkPositions at = link_positions(zx120(), corner);
  const Eigen::Vector2d about_arm = at.tip - at.arm_pin, about_bucket = at.tip - at.bucket_pin;
  const double tip_motion = (about_bucket - about_arm).norm();  // of unit turns, clockwise
  for (const double off : {2e-4, 5e-4, 1e-3}) {
    const Trajectory trajectory = time_dig_path(zx120(), two_straight_phases(), {1.0, off});
    const double reach = 4.0 * off / tip_motion;
    double deepest = 0.0;
    for (const TrajectoryPoint& point : trajectory.points) {
      const double before = corner[1] - point.joints[1], after = point.joints[2] - corner[2];
      const double along = after - before;  // from the corner, both lines at a right angle
      const double share = std::max(0.0, 1.0 - std::abs(along) / reach);
      const JointAngles on_path =
          along < 0 ? JointAngles(-0.3, 1.7 + along, 0.5) : JointAngles(-0.3, 1.7, 0.5 + along);
      EXPECT_LT((point.joints - on_path - 0.25 * reach * share * share * turn).norm(), 1e-12);
      const BucketPose tip = forward_kinematics(zx120(), point.joints);
      const BucketPose path_tip = forward_kinematics(zx120(), on_path);
      deepest = std::max(deepest, std::hypot(tip.x - path_tip.x, tip.z - path_tip.z));
    }
    EXPECT_NEAR(deepest, off, 0.01 * off);
    ASSERT_EQ(rates_between_phases(trajectory).size(), 1u);
    const JointAngles through = rates_between_phases(trajectory)[0];
    EXPECT_GT(through[1], 0.0);
    EXPECT_NEAR(through[1], through[2], 1e-12);
  }
}

TEST(Trajectory, SlowerLimitsTakeLonger) {
  const double full = time_dig_path(zx120(), fixed_path(), {1.0}).duration();
  const double half = time_dig_path(zx120(), fixed_path(), {0.5}).duration();
  EXPECT_GT(half, full * std::sqrt(2.0) - 1e-9);
  EXPECT_LT(half, full * 2.0 + 1e-9);
}

// ---- properties ---------------------------------------------------------------------------------

TEST(Trajectory, GoesThroughThePosesOfThePathAndRestsBetweenPhasesWithoutTolerance) {
  const DigPath path = fixed_path();
  const Trajectory trajectory = time_dig_path(zx120(), path, {0.8, 0.0});
  ASSERT_EQ(trajectory.points.size(), path.poses.size());
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    EXPECT_EQ(trajectory.points[k].joints, path.poses[k].joints);
    EXPECT_EQ(trajectory.points[k].phase, path.poses[k].phase);
    EXPECT_EQ(trajectory.points[k].bucket.floor_angle, path.poses[k].bucket.floor_angle);
  }
  expect_well_formed(trajectory);
  EXPECT_EQ(rates_between_phases(trajectory).size(), 3u);
  for (const JointAngles& rates : rates_between_phases(trajectory)) EXPECT_EQ(rates.norm(), 0.0);
}

TEST(Trajectory, LeavesNoPoseOutAwayFromTheCorners) {
  const DigPath path = fixed_path();
  const Trajectory trajectory = time_dig_path(zx120(), path);
  std::size_t passed = 0;
  for (const DigPose& pose : path.poses) {
    for (const TrajectoryPoint& point : trajectory.points) passed += point.joints == pose.joints;
  }
  EXPECT_GE(passed, path.poses.size() - 3 * 3);
}

TEST(Trajectory, GoesThroughCornersAndIsFasterTheMoreItMayCutThem) {
  double last = std::numeric_limits<double>::infinity();
  for (const double off : {0.0, 2.5e-4, 1e-3, 4e-3, 1e-2}) {
    const Trajectory trajectory = time_dig_path(zx120(), fixed_path(), {1.0, off});
    EXPECT_LT(trajectory.dig_duration(), last);
    last = trajectory.dig_duration();
    for (const JointAngles& rates : rates_between_phases(trajectory)) {
      EXPECT_EQ(rates.norm() > 0.0, off > 0.0);
    }
  }
  const double stopping = time_dig_path(zx120(), fixed_path(), {1.0, 0.0}).dig_duration();
  EXPECT_LT(time_dig_path(zx120(), fixed_path(), {1.0}).dig_duration(), 0.985 * stopping);
}

TEST(Trajectory, StopsWhereTheJointsTurnBack) {
  std::vector<JointAngles> joints;
  for (int i = 0; i <= 20; ++i) joints.emplace_back(-0.3, 1.5, 0.5 + 0.01 * i);
  for (int i = 1; i <= 20; ++i) joints.emplace_back(-0.3, 1.5 + 0.002 * i, 0.7 - 0.01 * i);
  DigPath path = path_through(joints);
  for (std::size_t i = 21; i < path.poses.size(); ++i) path.poses[i].phase = DigPhase::lift;
  const Trajectory trajectory = time_dig_path(zx120(), path);
  ASSERT_EQ(trajectory.points.size(), path.poses.size());
  EXPECT_EQ(trajectory.points[20].joints, path.poses[20].joints);
  EXPECT_EQ(trajectory.points[20].rates.norm(), 0.0);
}

TEST(Trajectory, ComesDownBeforeItDigs) {
  DigPath path = fixed_path();
  path.approach = std::get<std::vector<DigPose>>(way_down(zx120(), path, flat_ground_at));
  const Trajectory trajectory = time_dig_path(zx120(), path);
  expect_well_formed(trajectory);
  EXPECT_EQ(trajectory.points.front().phase, DigPhase::approach);
  EXPECT_EQ(trajectory.points.front().joints, path.approach.front().joints);
  EXPECT_EQ(rates_between_phases(trajectory).size(), 4u);
  BucketPose touch;  // the path's first pose is the corner between approach and penetration
  for (const TrajectoryPoint& point : trajectory.points) {
    if (point.phase == DigPhase::approach) touch = point.bucket;
  }
  const BucketPose& start = path.poses.front().bucket;
  EXPECT_LE(std::hypot(touch.x - start.x, touch.z - start.z), 1.01e-3);
  const Trajectory alone = time_dig_path(zx120(), fixed_path());
  EXPECT_NEAR(trajectory.dig_duration(), alone.dig_duration(), 0.1);
  EXPECT_GT(trajectory.duration(), alone.duration() + 0.5);
}

struct RandomDig {
  Machine machine;
  DigPath path;
  TrajectoryOptions options;
};

/// Somewhere on a slope of up to 20 degrees, by a machine that is up to twice as fast or slow.
/// `shrink` may make the phases shorter.
RandomDig random_dig(
    Random& random, const DigPathOptions& layout = {},
    const std::function<void(DigParameters&)>& shrink = [](DigParameters&) {}) {
  RandomDig dig{zx120(), {}, {random.uniform(0.3, 1.0), std::min(1e-3, random.uniform(0.0, 2e-3))}};
  for (JointLimits& limits : dig.machine.limits) {
    limits.speed *= std::exp2(random.uniform(-1, 1));
    limits.acceleration *= std::exp2(random.uniform(-1, 1));
  }
  // Pumps of 95 to 380 L/min, so that the flow is often the limit.
  dig.machine.hydraulics->pump_flow = 0.00317 * std::exp2(random.uniform(-1, 1));
  for (Piston& piston : dig.machine.hydraulics->pistons) piston.speed = random.uniform(0.1, 0.6);
  while (true) {
    DigParameters parameters;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      parameters.*info.field = random.uniform(info.lower, info.upper);
    }
    shrink(parameters);
    const double slope = std::tan(random.uniform(-0.35, 0.35));
    const auto ground = [slope](double x) { return slope * (x - 6.0); };
    auto outcome = make_dig_path(dig.machine, parameters, random.uniform(3.0, 8.0), ground, layout);
    if (!std::holds_alternative<DigPath>(outcome)) continue;
    dig.path = std::get<DigPath>(std::move(outcome));
    auto approach = way_down(dig.machine, dig.path, ground, layout);
    if (auto* poses = std::get_if<std::vector<DigPose>>(&approach)) dig.path.approach = *poses;
    return dig;
  }
}

TEST(Trajectory, TenThousandDigsKeepTheirLimitsAndTheirPathAtEveryPoint) {
  Random random(21), loads(24);
  Used mean;
  double attitude = 0.0;
  for (int n = 0; n < test::many; ++n) {
    const RandomDig dig = random_dig(random);
    JointAngles torque;
    for (double& load : torque) load = loads.uniform(-1.5e5, 1.5e5);
    const Trajectory trajectory =
        time_dig_path(dig.machine, dig.path, dig.options, throughout(dig.path, torque));
    expect_well_formed(trajectory);
    const Used used = used_of(dig.machine, trajectory, torque);
    ASSERT_NO_FATAL_FAILURE(expect_within(used, dig.options.speed_fraction)) << n;
    mean.acceleration += used.acceleration / dig.options.speed_fraction / test::many;
    mean.speed += std::max({used.speed, used.cylinder_speed, used.flow, used.power}) /
                  dig.options.speed_fraction / test::many;
    Deviation deviation(dig.machine, dig.path);
    deviation.add(trajectory);
    ASSERT_LE(deviation.tip(), 1e-3) << n;
    attitude = std::max(attitude, deviation.attitude());
  }
  EXPECT_GT(mean.speed, 0.98);  // fast as well as safe: something is nearly always at its limit
  EXPECT_GT(mean.acceleration, 0.9);
  EXPECT_LT(attitude, 2e-3);
}

/// The same path in the joints, with the tip moving at most a default step between poses.
DigPath refined(const Machine& machine, const DigPath& path) {
  DigPath fine = path;
  fine.approach.clear();
  fine.poses = path.approach;
  fine.poses.insert(fine.poses.end(), path.poses.begin(), path.poses.end());
  std::vector<DigPose> poses = {fine.poses.front()};
  for (std::size_t k = 1; k < fine.poses.size(); ++k) {
    const DigPose &from = fine.poses[k - 1], &to = fine.poses[k];
    const double travel = std::hypot(to.bucket.x - from.bucket.x, to.bucket.z - from.bucket.z);
    const int steps = std::max(1, static_cast<int>(std::ceil(travel / DigPathOptions{}.step)));
    for (int i = 1; i <= steps; ++i) {
      poses.push_back(to);
      poses.back().joints += (1.0 - static_cast<double>(i) / steps) * (from.joints - to.joints);
      poses.back().bucket = forward_kinematics(machine, poses.back().joints);
    }
  }
  fine.poses = std::move(poses);
  return fine;
}

TEST(Trajectory, WhateverTheStepRoundingCostsNoTimeAndKeepsLimitsAndPath) {
  Random random(23);
  double mean = 0.0;
  const int count = test::tried_of(3000);
  for (int n = 0; n < count; ++n) {
    DigPathOptions layout;
    if (n % 2 == 0) layout.step *= std::exp2(random.uniform(-2, 6));
    const RandomDig dig = random_dig(random, layout, [&](DigParameters& parameters) {
      parameters.penetration_length *= std::min(1.0, std::pow(10.0, random.uniform(-3, 1)));
      parameters.drag_length *= std::min(1.0, std::pow(10.0, random.uniform(-3, 1)));
    });
    const Trajectory rounded = time_dig_path(dig.machine, dig.path, dig.options);
    expect_well_formed(rounded);
    ASSERT_NO_FATAL_FAILURE(
        expect_within(used_of(dig.machine, rounded), dig.options.speed_fraction))
        << n;
    Deviation deviation(dig.machine, refined(dig.machine, dig.path));
    deviation.add(rounded);
    ASSERT_LE(deviation.tip(), 1e-3) << n << ", step " << layout.step;
    const double stopping =
        time_dig_path(dig.machine, dig.path, {dig.options.speed_fraction, 0.0}).duration();
    ASSERT_LT(rounded.duration(), 1.02 * stopping) << n << ", step " << layout.step;
    mean += rounded.duration() / stopping / count;
  }
  EXPECT_LT(mean, 0.985);
}

TEST(Trajectory, StatedRatesAreThoseOfTheJoints) {
  const Trajectory trajectory = time_dig_path(zx120(), fixed_path(0.002), {1.0});
  const auto& points = trajectory.points;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    if (points[k - 1].phase != points[k + 1].phase) continue;
    const JointAngles slope =
        (points[k + 1].joints - points[k - 1].joints) / (points[k + 1].time - points[k - 1].time);
    ASSERT_LT((slope - points[k].rates).norm(), 0.03) << points[k].time;
  }
}

TEST(Trajectory, UsesOnlyTheFractionOfTheLimitsItMay) {
  expect_within(used_of(zx120(), time_dig_path(zx120(), fixed_path(), {0.6})), 0.6);
}

TEST(Trajectory, RoughPathsKeepTheLimitsToo) {
  Random random(22);
  for (int n = 0; n < 200; ++n) {
    std::vector<JointAngles> joints = {JointAngles(-0.3, 1.5, 0.5)};
    const double size = std::pow(10.0, random.uniform(-6, -0.5));
    for (int i = 0; i < 20; ++i) {
      joints.push_back(joints.back() + size * JointAngles(random.uniform(-1, 1),
                                                          random.uniform(-1, 1),
                                                          random.uniform(-1, 1)));
    }
    const Trajectory trajectory = time_dig_path(zx120(), path_through(joints), {1.0});
    expect_well_formed(trajectory);
    ASSERT_NO_FATAL_FAILURE(expect_within(used_of(zx120(), trajectory), 1.0));
  }
}

// ---- degenerate paths ---------------------------------------------------------------------------

TEST(Trajectory, DigsWithEmptyOrTinyPhasesAreTimed) {
  for (const double push : {0.0, 1e-310, 1e-9, 1e-3}) {
    for (const double drag : {0.0, 1e-310, 1e-9, 1e-3}) {
      const auto path =
          std::get<DigPath>(make_dig_path(zx120(), {0.7, push, drag}, 6.0, flat_ground_at));
      const Trajectory trajectory = time_dig_path(zx120(), path, {1.0});
      expect_well_formed(trajectory);
      ASSERT_NO_FATAL_FAILURE(expect_within(used_of(zx120(), trajectory), 1.0));
    }
  }
}

TEST(Trajectory, PhaseOfASingleStepGetsAPointHalfway) {
  const Trajectory trajectory =
      time_dig_path(zx120(), path_through({{-0.3, 1.5, 0.5}, {-0.3, 1.5, 0.7}}), {1.0});
  ASSERT_EQ(trajectory.points.size(), 3u);
  EXPECT_NEAR(trajectory.points[1].joints[2], 0.6, 1e-15);
  EXPECT_NEAR(trajectory.duration(), 2.0 * std::sqrt(0.2 / 1.5), 1e-9);
}

TEST(Trajectory, PosesThatDoNotMoveAreDropped) {
  const JointAngles a(-0.3, 1.5, 0.5), b(-0.3, 1.5, 0.6), c(-0.3, 1.5, 0.7);
  EXPECT_EQ(time_dig_path(zx120(), path_through({a, a, b, b, b, c, c})).points.size(), 3u);
  const Trajectory still = time_dig_path(zx120(), path_through({a, a}));
  EXPECT_EQ(still.points.size(), 1u);
  EXPECT_EQ(still.duration(), 0.0);
  EXPECT_EQ(Trajectory().duration(), 0.0);
  EXPECT_EQ(Trajectory().dig_duration(), 0.0);
}

TEST(Trajectory, BadInputIsAnErrorThatNamesIt) {
  const auto complaint = [](const DigPath& path, double fraction) {
    return test::error_of([&] { time_dig_path(zx120(), path, {fraction}); });
  };
  const std::string rule = ", must be above 0 and at most 1";
  EXPECT_EQ(complaint(fixed_path(), 0.0), "TrajectoryOptions::speed_fraction is 0" + rule);
  EXPECT_EQ(complaint(fixed_path(), 1.1), "TrajectoryOptions::speed_fraction is 1.1" + rule);
  EXPECT_EQ(complaint(fixed_path(), std::numeric_limits<double>::quiet_NaN()),
            "TrajectoryOptions::speed_fraction is nan" + rule);
  EXPECT_EQ(test::error_of([] {
              time_dig_path(zx120(), fixed_path(), {0.8, 0.02});
            }),
            "TrajectoryOptions::corner_tolerance is 0.02, must be in 0 .. 0.01 m");
  EXPECT_EQ(complaint(DigPath(), 0.8), "the dig path has 0 poses, must have at least 2");
  DigPath broken = fixed_path();
  broken.poses[3].joints[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(broken, 0.8), "pose 3 of the dig path has a joint that is not finite");
}

// ---- files --------------------------------------------------------------------------------------

Trajectory with_approach() {
  DigPath path = fixed_path();
  path.approach = std::get<std::vector<DigPose>>(way_down(zx120(), path, flat_ground_at));
  return time_dig_path(zx120(), path);
}

std::vector<double> numbers_of(const TrajectoryPoint& point) {
  std::vector<double> numbers = {point.time};
  const auto add = [&](const Eigen::Vector3d& v) {
    numbers.insert(numbers.end(), v.begin(), v.end());
  };
  add(point.joints);
  add({point.bucket.x, point.bucket.z, point.bucket.floor_angle});
  add(point.rates);
  add(point.cylinders);
  add(point.cylinder_speeds);
  return numbers;
}

TEST(Trajectory, StatesItsCylinders) {
  for (const TrajectoryPoint& point : with_approach().points) {
    const auto states = cylinder_states(*zx120().cylinders, point.joints);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(point.cylinders[i], states[static_cast<std::size_t>(i)].length);
      EXPECT_EQ(point.cylinder_speeds[i],
                states[static_cast<std::size_t>(i)].lever * point.rates[i]);
    }
  }
}

TEST(Trajectory, CsvHoldsEveryPointExactly) {
  const Trajectory trajectory = with_approach();
  std::istringstream csv(to_csv(trajectory));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_EQ(line,
            "time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad,"
            "boom_rad_per_s,arm_rad_per_s,bucket_rad_per_s,"
            "boom_cylinder_m,arm_cylinder_m,bucket_cylinder_m,"
            "boom_cylinder_m_per_s,arm_cylinder_m_per_s,bucket_cylinder_m_per_s");
  for (const TrajectoryPoint& point : trajectory.points) {
    ASSERT_TRUE(std::getline(csv, line));
    std::istringstream fields(line);
    std::string field;
    std::vector<double> values;
    while (std::getline(fields, field, ',')) {
      if (values.size() == 1 && field == name(point.phase)) continue;
      double value = 0.0;
      const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
      ASSERT_EQ(result.ptr, field.data() + field.size()) << line;
      values.push_back(value);
    }
    EXPECT_EQ(values, numbers_of(point));
  }
  EXPECT_FALSE(std::getline(csv, line));
}

TEST(Trajectory, CsvOfAMachineWithoutCylindersHasNoneEither) {
  Machine bare = zx120();
  bare.cylinders.reset();
  bare.hydraulics.reset();
  const std::string csv = to_csv(time_dig_path(bare, fixed_path()));
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad,"
            "boom_rad_per_s,arm_rad_per_s,bucket_rad_per_s");
  EXPECT_EQ(csv.find("nan"), std::string::npos);
}

TEST(Trajectory, JsonIsReadBackExactly) {
  const test::TemporaryFolder folder;
  Machine bare = zx120();
  bare.cylinders.reset();
  bare.hydraulics.reset();
  for (const Trajectory& written : {with_approach(), time_dig_path(bare, fixed_path())}) {
    const Trajectory read = load_trajectory(folder.write("t.json", to_json(written)));
    EXPECT_EQ(read.machine, "zx120");
    ASSERT_EQ(read.points.size(), written.points.size());
    for (std::size_t k = 0; k < read.points.size(); ++k) {
      EXPECT_EQ(read.points[k].phase, written.points[k].phase);
      const auto a = numbers_of(read.points[k]), b = numbers_of(written.points[k]);
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])));
      }
    }
    EXPECT_EQ(to_json(read), to_json(written));
  }
}

TEST(Trajectory, JsonCarriesThePlanItsPoseAndItsExpiry) {
  const test::TemporaryFolder folder;
  Trajectory written = with_approach();
  EXPECT_FALSE(load_trajectory(folder.write("t.json", to_json(written))).plan);
  written.plan = PlanStamp{"0123456789abcdef"};
  written.plan->pose.translate(Eigen::Vector3d(3.0, -2.0, 0.5));
  written.plan->pose.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.1, -0.2, 1.0).normalized()));
  written.plan->expires = 1'790'000'060'500'000'000;
  const Trajectory read = load_trajectory(folder.write("t.json", to_json(written)));
  ASSERT_TRUE(read.plan);
  EXPECT_EQ(read.plan->id, "0123456789abcdef");
  EXPECT_TRUE(read.plan->pose.isApprox(written.plan->pose, 1e-12));
  EXPECT_FALSE(read.plan->scanned);
  ASSERT_TRUE(read.plan->expires);
  EXPECT_NEAR(1e-9 * static_cast<double>(*read.plan->expires - *written.plan->expires), 0.0, 1e-6);
}

TEST(Trajectory, JsonNamesKeyValueAndRuleOfWhatItRefuses) {
  const auto complaint = [](const std::function<void(nlohmann::json&)>& change) {
    nlohmann::json json = nlohmann::json::parse(to_json(with_approach()));
    change(json);
    const test::TemporaryFolder folder;
    const std::string file = folder.write("t.json", json.dump());
    return test::error_about([&] { load_trajectory(file); }, file);
  };
  using nlohmann::json;
  EXPECT_EQ(complaint([](json&) {}), "no error");
  EXPECT_EQ(complaint([](json& t) { t["points"] = json::array(); }), "points: holds no point");
  EXPECT_EQ(
      complaint([](json& t) { t["points"].erase(0); }).rfind("points: begins at time_s = ", 0), 0u);
  EXPECT_EQ(complaint([](json& t) { t["points"][4]["time_s"] = t["points"][3]["time_s"]; }),
            "points: time_s must rise, point 5 does not");
  EXPECT_EQ(complaint([](json& t) { t["points"][60]["phase"] = "approach"; }),
            "points: phases must be in order, point 61 goes back to approach");
  EXPECT_NE(complaint([](json& t) { t["points"][2]["phase"] = "turn"; })
                .find("phase: is 'turn', must be approach, penetrate, drag, scoop, lift, swing, "
                      "dump or back"),
            std::string::npos);
  EXPECT_NE(complaint([](json& t) {
              t["points"][2].erase("cylinders_m");
            }).find("cylinders_m: is missing"),
            std::string::npos);
  EXPECT_EQ(complaint([](json& t) { t["duration"] = 1; }), "duration: is not a key of this file");
}

}  // namespace
}  // namespace excavplan
