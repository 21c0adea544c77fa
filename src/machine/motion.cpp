// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/error.hpp>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "machine/drive_limits.hpp"
#include "machine/motion_path.hpp"

namespace excavplan {
namespace {

// Ours:
constexpr double slowest_rate = 10.0, fastest_rate = 500.0;  // [1/s]
constexpr double least_jerk = 0.1;                           // [rad/s^3]
constexpr double most_swing = 4.0 * pi;                      // [rad]
constexpr double largest_tolerance = 0.01;                   // of a corner [m]
constexpr double drift = 0.002;        // of the tip by one joint, from the smoothing in time [m]
constexpr double checked_step = 1e-3;  // of cylinders, flow and power [s]
constexpr double spare_drive = 1e-3;   // of their limits, for the time between the checks
constexpr double rounding = 1e-9;      // of a joint beyond its limit [rad]

void check_joints(const Machine& machine, const FrontJoints& joints, const std::string& pose) {
  for (std::size_t i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.limits[i];
    const double angle = joints[static_cast<Eigen::Index>(i)];
    if (angle >= limits.lower - rounding && angle <= limits.upper + rounding) continue;
    require_in(pose + ": " + name(static_cast<Joint>(i)) + " [rad]", angle, limits.lower,
               limits.upper);
  }
  require_in(pose + ": swing [rad]", joints[3], -most_swing, most_swing);
}

void check(const Machine& machine, const Way& way) {
  bool moves = false, swings = false;
  for (std::size_t i = 0; i < way.poses.size(); ++i) {
    const WayPose& pose = way.poses[i];
    const std::string which = "pose " + std::to_string(i) + " of the way";
    check_joints(machine, pose.joints, which);
    require(pose.torque.allFinite(), which + " has a torque that is not finite");
    if (i == 0) continue;
    require(pose.phase >= way.poses[i - 1].phase, which + ": its phase is before the last one's");
    moves = moves || (pose.joints - way.poses[i - 1].joints).norm() > rounding;
    swings = swings || pose.joints[3] != way.poses.front().joints[3];
  }
  require(moves, "the way has fewer than 2 poses that differ");
  if (!swings) return;
  require(machine.swing.has_value(),
          "the way swings, but the file of machine " + machine.name + " has no swing");
  require(std::isfinite(way.swing_acceleration) && way.swing_acceleration > 0.0,
          "Way::swing_acceleration", way.swing_acceleration, "above 0 and finite");
}

// ---- how fast along the path --------------------------------------------------------------------

/// Limits of all four joints, times the speed fraction.
struct FrontLimits {
  FrontJoints per_speed = FrontJoints::Zero();
  FrontJoints acceleration = FrontJoints::Ones();

  FrontLimits(const Machine& machine, const Way& way, double fraction) {
    for (int i = 0; i < 3; ++i) {
      const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
      per_speed[i] = 1.0 / (fraction * limits.speed);
      acceleration[i] = fraction * limits.acceleration;
    }
    if (!machine.swing || !(way.swing_acceleration > 0.0)) return;
    per_speed[3] = 1.0 / (fraction * machine.swing->speed);
    acceleration[3] = fraction * way.swing_acceleration;
  }
};

/// The squared speed (ds/dt)² along a path, linear within each cell. So are the accelerations
/// q' d²s/dt² + q'' (ds/dt)², as q' is linear too: they keep their limits within a cell if they do
/// at both of its ends. Largest squared speeds from which the rest of the path can be driven,
/// backwards, then the largest of these, forwards (Pham and Pham 2018).
class Profile {
 public:
  Profile(const SmoothPath& path, const FrontJoints& acceleration)
      : path_(path), acceleration_(acceleration), squared_(path.cells.size() + 1) {}

  /// @param ceilings  of the squared speed in each cell
  void run(const std::vector<double>& ceilings) {
    std::fill(squared_.begin(), squared_.end(), 0.0);
    for (std::size_t i = 1; i < path_.stops.size(); ++i) {
      run(ceilings, path_.stops[i - 1], path_.stops[i]);
    }
  }

  /// At the begin of each cell, and the end of the last [rad²/s²].
  const std::vector<double>& squared() const { return squared_; }

 private:
  struct Interval {
    double low, high;
    bool empty() const { return !(low <= high); }
  };

  void run(const std::vector<double>& ceilings, std::size_t first, std::size_t last) {
    for (std::size_t k = last - 1; k > first; --k) {
      const double most = std::min(ceilings[k - 1], ceilings[k]);
      squared_[k] = largest_before(path_.cells[k], squared_[k + 1], most);
    }
    for (std::size_t k = first; k + 1 < last; ++k) {
      const Interval after = reachable(path_.cells[k], squared_[k], squared_[k + 1]);
      squared_[k + 1] = std::max(0.0, after.high);
    }
  }

  /// Squared speeds at the end of a cell that the accelerations allow after one at its begin.
  Interval reachable(const PathCell& cell, double before, double most) const {
    Interval after = {0.0, most};
    const double per_length = 0.5 / cell.length;
    const FrontJoints last = cell.last_slope();
    for (int i = 0; i < 4; ++i) {
      const double limit = acceleration_[i], bend = cell.bend[i];
      const double first = cell.slope[i] * per_length, second = last[i] * per_length;
      narrow(after, (bend - first) * before, first, limit);
      narrow(after, -second * before, bend + second, limit);
    }
    return after;
  }

  /// |constant + factor · x| <= limit
  static void narrow(Interval& x, double constant, double factor, double limit) {
    if (factor == 0.0) {
      if (std::abs(constant) > limit) x.high = -1.0;
      return;
    }
    const double a = (-limit - constant) / factor, b = (limit - constant) / factor;
    x.low = std::max(x.low, std::min(a, b));
    x.high = std::min(x.high, std::max(a, b));
  }

  double largest_before(const PathCell& cell, double after, double most) const {
    if (!reachable(cell, most, after).empty()) return most;
    double low = 0.0, high = most;  // 0 is always possible: the machine then stays at rest
    for (int i = 0; i < 60 && high - low > 1e-12 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (reachable(cell, middle, after).empty() ? high : low) = middle;
    }
    return low;
  }

  const SmoothPath& path_;
  FrontJoints acceleration_;
  std::vector<double> squared_;
};

/// Boom, arm and bucket at one place, as far as their drive is concerned.
struct DriveState {
  JointAngles rates;       ///< [rad/s], or of dq/ds
  Eigen::Vector3d levers;  ///< of the cylinders; 0 of a joint that rests [m/rad]
  JointAngles torque;      ///< [N m]

  DriveState(const Machine& machine, const FrontJoints& joints, const FrontJoints& all_rates,
             JointAngles against)
      : rates(all_rates.head<3>()), levers(Eigen::Vector3d::Zero()), torque(std::move(against)) {
    if (!machine.hydraulics) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      if (rates[joint] != 0.0) levers[joint] = (*machine.cylinders)[i].at(joints[joint]).lever;
    }
  }
};

/// Largest ratio of cylinder speeds, flow and power to their limits between two states: a joint may
/// turn round, or its torque jump, anywhere between them.
double drive_load(const DriveLimits& drive, const DriveState& a, const DriveState& b) {
  double pressure = 0.0, load = 0.0;
  for (const DriveState* state : {&a, &b}) {
    for (const DriveState* other : {&a, &b}) {
      pressure = std::max(pressure, drive.pressure(other->torque, state->rates, state->levers));
      load = std::max(load, drive.power_load(other->torque, state->rates));
    }
  }
  for (const DriveState* state : {&a, &b}) {
    const Eigen::Vector3d growth = state->levers.cwiseProduct(state->rates);
    load = std::max(load, drive.cylinder_load(growth, pressure));
  }
  return load;
}

/// Ceilings of the squared speed in each cell from all limits but the accelerations [rad²/s²].
std::vector<double> ceilings_of(const Machine& machine, const SmoothPath& path,
                                const FrontLimits& limits, const DriveLimits& drive) {
  std::vector<double> ceilings;
  for (const PathCell& cell : path.cells) {
    const FrontJoints last = cell.last_slope();
    const FrontJoints steepest = cell.slope.cwiseAbs().cwiseMax(last.cwiseAbs());
    const DriveState begin(machine, cell.begin, cell.slope, cell.torque);
    const DriveState end(machine, cell.at(cell.length), last, cell.torque);
    const double load =
        std::max(steepest.cwiseProduct(limits.per_speed).maxCoeff(), drive_load(drive, begin, end));
    ceilings.push_back(1.0 / (load * load));
  }
  return ceilings;
}

/// The way over time, as fast as a profile.
class TimedPath {
 public:
  TimedPath(const SmoothPath& path, const std::vector<double>& squared)
      : path_(path), squared_(squared), times_(1, 0.0) {
    for (std::size_t k = 0; k < path.cells.size(); ++k) {
      const double sum = std::sqrt(squared[k]) + std::sqrt(squared[k + 1]);
      times_.push_back(times_.back() + 2.0 * path.cells[k].length / sum);
    }
  }

  double duration() const { return times_.back(); }

  /// The cell that leads to this time.
  std::size_t cell_at(double time) const {
    const auto end = std::lower_bound(times_.begin() + 1, times_.end() - 1, time);
    return static_cast<std::size_t>(end - times_.begin()) - 1;
  }

  /// Speed in a cell [rad²/s²].
  double largest_squared(std::size_t cell) const {
    return std::max(squared_[cell], squared_[cell + 1]);
  }

  FrontJoints joints_at(double time) const {
    const std::size_t k = cell_at(time);
    const PathCell& cell = path_.cells[k];
    const double since = std::clamp(time - times_[k], 0.0, times_[k + 1] - times_[k]);
    const double growth = (squared_[k + 1] - squared_[k]) / (4.0 * cell.length);
    const double s = since * (std::sqrt(squared_[k]) + since * growth);
    return cell.at(std::clamp(s, 0.0, cell.length));
  }

 private:
  const SmoothPath& path_;
  const std::vector<double>& squared_;
  std::vector<double> times_;  // at the begin of each cell, and the end of the last [s]
};

// ---- smoothing in time --------------------------------------------------------------------------

/// How the joints are smoothed: the mean of `window` samples, then the B-spline of these. Both are
/// means with positive weights, so that no rate or acceleration grows.
struct Smoothing {
  double step = 0.0;  ///< between samples [s]
  std::size_t window = 1;
  FrontJoints acceleration = FrontJoints::Zero();  ///< at which all its limits hold

  Smoothing(const Machine& machine, const MotionOptions& options, const FrontJoints& most)
      : step(std::round(1e9 / options.rate) / 1e9), acceleration(most) {
    const double off = drift / (machine.boom_pin.x() + machine.full_length());  // of a joint [rad]
    const double jerk = options.max_jerk;
    if (std::isfinite(jerk)) {
      // A mean over w = 2 a / jerk keeps the jerk; it moves a joint by at most a w² / 24.
      const double used = std::min(most.maxCoeff(), std::cbrt(6.0 * jerk * jerk * off));
      window = static_cast<std::size_t>(std::max(1.0, std::ceil(2.0 * used / (jerk * step))));
      acceleration = acceleration.cwiseMin(0.5 * jerk * step * static_cast<double>(window));
    }
    const double wide = static_cast<double>(window);
    const double variance = step * step * (4.0 + wide * wide - 1.0) / 12.0;
    acceleration = acceleration.cwiseMin(2.0 * off / variance);
  }
};

/// The uniform cubic B-spline of the smoothed samples, with repeated ends, where it rests.
class SmoothMotion {
 public:
  SmoothMotion(const TimedPath& path, const Smoothing& smoothing)
      : step_(smoothing.step), delay_(0.5 * static_cast<double>(smoothing.window - 1)) {
    const auto steps = static_cast<std::size_t>(std::ceil(path.duration() / step_));
    std::vector<FrontJoints> samples;
    for (std::size_t j = 0; j <= steps; ++j) {
      samples.push_back(path.joints_at(static_cast<double>(j) * step_));
    }
    const std::size_t window = smoothing.window;
    const FrontJoints first = samples.front(), last = samples.back();
    control_.assign(2, first);
    // Sums from the first sample, so that joints at rest stay exactly there.
    FrontJoints sum = FrontJoints::Zero();
    for (std::size_t j = 0; j < samples.size() + window - 1; ++j) {
      sum += (j < samples.size() ? samples[j] : last) - first;
      if (j >= window) sum -= samples[j - window] - first;
      control_.push_back(first + sum / static_cast<double>(window));
    }
    control_.back() = last;
    control_.insert(control_.end(), 2, last);
  }

  std::size_t points() const { return control_.size() - 2; }
  double step() const { return step_; }
  /// How far the path counts to either side of a time [s].
  double reach() const { return (2.5 + delay_) * step_; }
  double time(std::size_t point) const { return static_cast<double>(point) * step_; }
  /// Of the path, `share` of a step after a point.
  double path_time(std::size_t point, double share = 0.0) const {
    return (static_cast<double>(point) - 1.0 - delay_ + share) * step_;
  }

  FrontJoints joints(std::size_t point, double share = 0.0) const {
    const double u = share, v = 1.0 - u;
    const FrontJoints* c = &control_[point];
    if (u == 0.0) return c[1] + ((c[2] - c[1]) - (c[1] - c[0])) / 6.0;
    return (v * v * v * c[0] + (3.0 * u * u * (u - 2.0) + 4.0) * c[1] +
            (3.0 * v * v * (v - 2.0) + 4.0) * c[2] + u * u * u * c[3]) /
           6.0;
  }
  FrontJoints rates(std::size_t point, double share = 0.0) const {
    const double u = share, v = 1.0 - u;
    const FrontJoints* c = &control_[point];
    if (u == 0.0) return (c[2] - c[0]) / (2.0 * step_);
    return (v * v * (c[1] - c[0]) + (1.0 + 2.0 * u * v) * (c[2] - c[1]) + u * u * (c[3] - c[2])) /
           (2.0 * step_);
  }
  FrontJoints accelerations(std::size_t point) const {
    const FrontJoints* c = &control_[point];
    return ((c[2] - c[1]) - (c[1] - c[0])) / (step_ * step_);
  }

 private:
  double step_;
  double delay_;                      // of the smoothing [steps]
  std::vector<FrontJoints> control_;  // point i lies among i, i + 1 and i + 2
};

/// Lowers the ceilings where the motion breaks a limit of the drive: in the cells that its place
/// was smoothed over. @return whether it does anywhere
bool lower_ceilings(const Machine& machine, const DriveLimits& drive, const SmoothPath& path,
                    const TimedPath& timed, const SmoothMotion& motion,
                    std::vector<double>& ceilings) {
  std::vector<double> loads(path.cells.size(), 1.0);
  bool any = false;
  const auto state_at = [&](std::size_t point, double share) {
    const PathCell& cell = path.cells[timed.cell_at(motion.path_time(point, share))];
    return DriveState(machine, motion.joints(point, share), motion.rates(point, share),
                      cell.torque);
  };
  const int parts = static_cast<int>(std::ceil(motion.step() / checked_step));
  DriveState before = state_at(0, 0.0);
  for (std::size_t i = 0; i + 1 < motion.points(); ++i) {
    for (int part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const DriveState now = state_at(i, share);
      const double load = drive_load(drive, std::exchange(before, now), now);
      if (load <= 1.0 + 0.5 * spare_drive) continue;
      any = true;
      const double at = motion.path_time(i, share);
      for (std::size_t k = timed.cell_at(at - motion.reach());
           k <= timed.cell_at(at + motion.reach()); ++k) {
        loads[k] = std::max(loads[k], load);
      }
    }
  }
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (loads[k] > 1.0) ceilings[k] = timed.largest_squared(k) / (loads[k] * loads[k]);
  }
  return any;
}

TrajectoryPoint point_of(const Machine& machine, const SmoothMotion& motion, std::size_t i) {
  const FrontJoints joints = motion.joints(i);
  const FrontJoints rates = motion.rates(i).array() + 0.0;  // no negative zero
  const FrontJoints accelerations = motion.accelerations(i).array() + 0.0;
  TrajectoryPoint point;
  point.time = motion.time(i);
  point.joints = joints.head<3>();
  point.rates = rates.head<3>();
  point.accelerations = accelerations.head<3>();
  point.swing = {joints[3], rates[3], accelerations[3]};
  point.bucket = forward_kinematics(machine, point.joints);
  if (machine.cylinders) {
    const auto states = cylinder_states(*machine.cylinders, point.joints);
    for (int k = 0; k < 3; ++k) {
      const CylinderState& state = states[static_cast<std::size_t>(k)];
      point.cylinders[k] = state.length;
      point.cylinder_speeds[k] = state.lever * point.rates[k] + 0.0;
    }
  }
  return point;
}

}  // namespace

void check(const MotionOptions& options) {
  require_in("MotionOptions::rate [1/s]", options.rate, slowest_rate, fastest_rate);
  require(options.speed_fraction > 0.0 && options.speed_fraction <= 1.0,
          "MotionOptions::speed_fraction", options.speed_fraction, "above 0 and at most 1");
  require(options.corner_tolerance >= 0.0 && options.corner_tolerance <= largest_tolerance,
          "MotionOptions::corner_tolerance", options.corner_tolerance,
          "in 0 .. " + number_text(largest_tolerance) + " m");
  require(options.max_jerk >= least_jerk, "MotionOptions::max_jerk", options.max_jerk,
          "at least " + number_text(least_jerk) + " rad/s^3");
}

Way way_of(const DigPath& path, const std::vector<JointAngles>& torques) {
  require(path.poses.size() >= 2,
          "the dig path has " + std::to_string(path.poses.size()) + " poses, must have at least 2");
  require(torques.size() < path.poses.size(),
          "there are " + std::to_string(torques.size()) + " torques between " +
              std::to_string(path.poses.size()) + " poses, must be fewer");
  Way way;
  const auto add = [&](DigPhase phase, const JointAngles& joints, const JointAngles& torque) {
    WayPose pose = {phase, FrontJoints::Zero(), torque};
    pose.joints.head<3>() = joints;
    way.poses.push_back(pose);
  };
  for (const DigPose& pose : path.approach) add(pose.phase, pose.joints, JointAngles::Zero());
  add(path.approach.empty() ? path.poses.front().phase : path.approach.back().phase,
      path.poses.front().joints, JointAngles::Zero());
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const JointAngles none = JointAngles::Zero();
    add(path.poses[i].phase, path.poses[i].joints, i <= torques.size() ? torques[i - 1] : none);
  }
  return way;
}

Trajectory time_way(const Machine& machine, const Way& way, const MotionOptions& options) {
  constexpr int most_rounds = 50;
  require_machine(machine);
  check(options);
  check(machine, way);
  const SmoothPath path = smooth_path(machine, way, options.corner_tolerance);
  const FrontLimits limits(machine, way, options.speed_fraction);
  const DriveLimits drive(machine, options.speed_fraction * (1.0 - spare_drive));
  const Smoothing smoothing(machine, options, limits.acceleration);
  std::vector<double> ceilings = ceilings_of(machine, path, limits, drive);
  Profile profile(path, smoothing.acceleration);
  for (int round = 0; round < most_rounds; ++round) {
    profile.run(ceilings);
    const TimedPath timed(path, profile.squared());
    constexpr double longest = 3600.0;  // ours [s]
    require(timed.duration() <= longest, "duration of the motion [s]", timed.duration(),
            "at most " + number_text(longest));
    const SmoothMotion motion(timed, smoothing);
    if (lower_ceilings(machine, drive, path, timed, motion, ceilings)) continue;
    Trajectory trajectory;
    trajectory.machine = machine.name;
    trajectory.robot_joints = machine.robot_joints;
    if (!machine.swing) trajectory.robot_joints[3].name.clear();
    for (std::size_t i = 0; i < motion.points(); ++i) {
      trajectory.points.push_back(point_of(machine, motion, i));
      trajectory.points.back().phase = path.cells[timed.cell_at(motion.path_time(i))].phase;
    }
    return trajectory;
  }
  refuse("no speed was found at which the cylinders of machine " + machine.name +
         " keep their limits on this way");
}

}  // namespace excavplan
