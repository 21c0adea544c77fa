// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "machine/corner_rules.hpp"
#include "machine/drive_limits.hpp"
#include "machine/front_check.hpp"
#include "machine/machine_mass.hpp"
#include "machine/motion_path.hpp"

namespace excavplan {
namespace {

// Ours:
constexpr double slowest_rate = 10.0, fastest_rate = 500.0;  // [1/s]
constexpr double least_jerk = 0.1;                           // [rad/s^3]
constexpr double drift = 0.002;        // of the tip by one joint, from the smoothing in time [m]
constexpr double checked_step = 1e-3;  // of cylinders, flow, power and torque of the swing [s]
constexpr double spare_drive = 1e-3;   // of their limits, for the time between the checks
constexpr double rounding_of_limits = 1e-9;  // of a joint beyond its limit [rad]

void check_way(const Machine& machine, const Way& way) {
  bool moves = false, swings = false;
  for (std::size_t i = 0; i < way.poses.size(); ++i) {
    const WayPose& pose = way.poses[i];
    const std::string which = "pose " + std::to_string(i) + " of the way";
    check_joints(machine, pose.joints, which, rounding_of_limits);
    require(pose.torque.allFinite(), which + " has a torque that is not finite");
    require_in(which + ": payload [kg]", pose.payload, 0.0, 1e9);
    if (i == 0) continue;
    require(pose.phase >= way.poses[i - 1].phase, which + ": its phase is before the last one's");
    moves = moves || (pose.joints - way.poses[i - 1].joints).norm() > rounding_of_limits;
    swings = swings || pose.joints[3] != way.poses.front().joints[3];
  }
  require(moves, "the way has fewer than 2 poses that differ");
  require(!swings || machine.swing.has_value(),
          "the way swings, but the file of machine " + machine.name + " has no swing");
}

// ---- how fast along the path --------------------------------------------------------------------

/// What the swing turns. Its torque is the change of the angular momentum: of the rate, and of the
/// inertia where the front moves in or out meanwhile.
class SwingLoad {
 public:
  SwingLoad(const Machine& machine, const Way& way) : machine_(machine) {
    const double first = way.poses.front().joints[3];
    for (const WayPose& pose : way.poses) turns_ = turns_ || pose.joints[3] != first;
    if (turns_) centre_ = cavity_centre(machine.bucket);
  }

  /// Whether anything turns.
  bool turns() const { return turns_; }
  /// About the axis [kg m^2]; 0 where nothing turns.
  double inertia(const FrontJoints& joints, double payload) const {
    return turns_ ? swing_inertia(machine_, centre_, joints.head<3>(), payload) : 0.0;
  }

 private:
  const Machine& machine_;
  bool turns_ = false;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
};

/// Limits of all four joints, times the speed fraction.
struct FrontLimits {
  FrontJoints per_speed = FrontJoints::Zero();
  FrontJoints acceleration = FrontJoints::Ones();
  double swing_torque = std::numeric_limits<double>::infinity();  ///< [N m]

  FrontLimits(const Machine& machine, const SmoothPath& path, const SwingLoad& swing,
              double fraction) {
    for (int i = 0; i < 3; ++i) {
      const JointLimits& limits = machine.limits[static_cast<std::size_t>(i)];
      per_speed[i] = 1.0 / (fraction * limits.speed);
      acceleration[i] = fraction * limits.acceleration;
    }
    if (!swing.turns()) return;
    double least = std::numeric_limits<double>::infinity();
    for (const PathCell& cell : path.cells) {
      least = std::min(least, swing.inertia(cell.begin, cell.payload));
    }
    per_speed[3] = 1.0 / (fraction * machine.swing->speed);
    acceleration[3] =
        fraction * std::min(machine.swing->acceleration, machine.swing->torque / least);
    swing_torque = fraction * (1.0 - spare_drive) * machine.swing->torque;
  }
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

/// Shares of the limits that the drive uses.
struct DriveLoad {
  double power = 0.0;   ///< of boom, arm and bucket
  double others = 0.0;  ///< the largest of cylinder speeds and flow

  double most(double swing_power = 0.0) const { return std::max(others, power + swing_power); }
};

/// The largest between two states: a joint may turn round, or its torque jump, anywhere between.
DriveLoad drive_load(const DriveLimits& drive, const DriveState& a, const DriveState& b) {
  double pressure = 0.0;
  DriveLoad load;
  for (const DriveState* state : {&a, &b}) {
    for (const DriveState* other : {&a, &b}) {
      pressure = std::max(pressure, drive.pressure(other->torque, state->rates, state->levers));
      load.power = std::max(load.power, drive.power_load(other->torque, state->rates));
    }
  }
  for (const DriveState* state : {&a, &b}) {
    const Eigen::Vector3d growth = state->levers.cwiseProduct(state->rates);
    load.power = std::max(load.power, pressure * drive.flow_load(growth));
    load.others = std::max(load.others, drive.cylinder_load(growth, 0.0));
  }
  return load;
}

/// What limits the speed in a cell of the path, besides the accelerations of the joints.
struct CellLimits {
  double squared = 0.0;  ///< highest speed [rad²/s²]
  double power = 0.0;    ///< of boom, arm and bucket: share of the limit over the speed [s/rad]
  double swing_torque = 0.0;  ///< highest [N m]
  double inertia = 0.0;       ///< of the swing at its begin [kg m^2]
  double last_inertia = 0.0;  ///< and at its end
};

std::vector<CellLimits> limits_of(const Machine& machine, const SmoothPath& path,
                                  const FrontLimits& limits, const DriveLimits& drive,
                                  const SwingLoad& swing) {
  std::vector<CellLimits> cells;
  for (const PathCell& cell : path.cells) {
    const FrontJoints last = cell.last_slope(), end = cell.at(cell.length);
    const FrontJoints steepest = cell.slope.cwiseAbs().cwiseMax(last.cwiseAbs());
    const DriveLoad load =
        drive_load(drive, DriveState(machine, cell.begin, cell.slope, cell.torque),
                   DriveState(machine, end, last, cell.torque));
    const double most = std::max(steepest.cwiseProduct(limits.per_speed).maxCoeff(), load.most());
    cells.push_back({1.0 / (most * most), load.power, limits.swing_torque,
                     swing.inertia(cell.begin, cell.payload), swing.inertia(end, cell.payload)});
  }
  return cells;
}

/// The squared speed (ds/dt)² along a path, linear within each cell. So are the accelerations
/// q' d²s/dt² + q'' (ds/dt)², as q' is linear too: they keep their limits within a cell if they do
/// at both of its ends. The torque of the swing is alike, with the inertia times q' in place of q'.
/// Largest squared speeds from which the rest of the path can be driven, backwards, then the
/// largest of these that the power allows, forwards (Pham and Pham 2018).
class Profile {
 public:
  /// @param limits  as they are at each run()
  Profile(const SmoothPath& path, const std::vector<CellLimits>& limits, FrontJoints acceleration,
          double per_power)
      : path_(path),
        limits_(limits),
        acceleration_(std::move(acceleration)),
        per_power_(per_power),
        squared_(path.cells.size() + 1) {}

  void run() {
    std::fill(squared_.begin(), squared_.end(), 0.0);
    for (std::size_t i = 1; i < path_.stops.size(); ++i) {
      run(path_.stops[i - 1], path_.stops[i]);
    }
  }

  /// At the begin of each cell, and the end of the last [rad²/s²].
  const std::vector<double>& squared() const { return squared_; }

 private:
  struct Interval {
    double low, high;
    bool empty() const { return !(low <= high); }
  };

  /// Angular momentum of the swing over ds/dt, at the ends of a cell [kg m^2].
  struct Momentum {
    double first, last;
  };

  Momentum momentum(std::size_t k) const {
    const CellLimits& limits = limits_[k];
    const PathCell& cell = path_.cells[k];
    return {limits.inertia * cell.slope[3], limits.last_inertia * cell.last_slope()[3]};
  }

  void run(std::size_t first, std::size_t last) {
    for (std::size_t k = last - 1; k > first; --k) {
      const double most = std::min(limits_[k - 1].squared, limits_[k].squared);
      squared_[k] = largest_before(k, squared_[k + 1], most);
    }
    for (std::size_t k = first; k + 1 < last; ++k) {
      const Interval after = reachable(k, squared_[k], squared_[k + 1]);
      squared_[k + 1] = std::max(0.0, largest_by_power(k, squared_[k], after));
    }
  }

  /// Squared speeds at the end of a cell that the accelerations allow after one at its begin.
  Interval reachable(std::size_t k, double before, double most) const {
    const PathCell& cell = path_.cells[k];
    Interval after = {0.0, most};
    const FrontJoints last = cell.last_slope();
    for (int i = 0; i < 4; ++i) {
      narrow(after, before, {cell.slope[i], last[i]}, cell, acceleration_[i]);
    }
    const Momentum swing = momentum(k);
    narrow(after, before, swing, cell, limits_[k].swing_torque);
    return after;
  }

  /// What changes from `ends.first` to `ends.last` times the speed may grow by at most the limit.
  static void narrow(Interval& after, double before, const Momentum& ends, const PathCell& cell,
                     double limit) {
    const double per_length = 0.5 / cell.length, bend = (ends.last - ends.first) / cell.length;
    const double first = ends.first * per_length, second = ends.last * per_length;
    narrow(after, (bend - first) * before, first, limit);
    narrow(after, -second * before, bend + second, limit);
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

  double largest_before(std::size_t k, double after, double most) const {
    if (!reachable(k, most, after).empty()) return most;
    // 0 is always possible: the machine then stays at rest.
    return largest(0.0, most, [&](double x) { return !reachable(k, x, after).empty(); });
  }

  double largest_by_power(std::size_t k, double before, const Interval& after) const {
    // At the highest speed of a cell it is 1 but for rounding, whatever follows.
    const auto suffices = [&](double x) { return power_share(k, before, x) <= 1.0 + 1e-9; };
    if (per_power_ == 0.0 || suffices(after.high)) return after.high;
    return largest(std::max(0.0, after.low), after.high, suffices);
  }

  /// Of the power that boom, arm, bucket and swing use at either end of a cell.
  double power_share(std::size_t k, double before, double after) const {
    const PathCell& cell = path_.cells[k];
    const Momentum swing = momentum(k);
    const double bend = (swing.last - swing.first) / cell.length;
    const double growth = 0.5 * (after - before) / cell.length;  // d²s/dt²
    const auto share = [&](double squared, double momentum, double slope) {
      const double torque = momentum * growth + bend * squared;
      return std::sqrt(std::max(0.0, squared)) *
             (limits_[k].power + per_power_ * std::max(0.0, torque * slope));
    };
    return std::max(share(before, swing.first, cell.slope[3]),
                    share(after, swing.last, cell.last_slope()[3]));
  }

  /// Between a value that is possible and one that is not.
  template <typename Possible>
  static double largest(double low, double high, const Possible& possible) {
    for (int i = 0; i < 60 && high - low > 1e-12 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (possible(middle) ? low : high) = middle;
    }
    return low;
  }

  const SmoothPath& path_;
  const std::vector<CellLimits>& limits_;
  FrontJoints acceleration_;
  double per_power_;  // [1/W]
  std::vector<double> squared_;
};

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
    const auto wide = static_cast<double>(window);
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
      control_.emplace_back(first + sum / static_cast<double>(window));
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
  FrontJoints accelerations(std::size_t point, double share = 0.0) const {
    const FrontJoints* c = &control_[point];
    const FrontJoints at = (c[2] - c[1]) - (c[1] - c[0]);
    if (share == 0.0) return at / (step_ * step_);
    const FrontJoints next = (c[3] - c[2]) - (c[2] - c[1]);
    return (at + share * (next - at)) / (step_ * step_);
  }

 private:
  double step_;
  double delay_;                      // of the smoothing [steps]
  std::vector<FrontJoints> control_;  // point i lies among i, i + 1 and i + 2
};

/// Compares a motion with what does not depend linearly on its joints, and lowers the limits of the
/// cells over which it was smoothed where it is exceeded.
class MotionCheck {
 public:
  MotionCheck(const Machine& machine, const DriveLimits& drive, const SwingLoad& swing,
              double swing_torque)
      : machine_(machine), drive_(drive), swing_(swing), swing_torque_(swing_torque) {}

  /// @return whether it is exceeded anywhere
  bool lower(const SmoothPath& path, const TimedPath& timed, const SmoothMotion& motion,
             std::vector<CellLimits>& limits) const {
    std::vector<Loads> loads(path.cells.size());
    bool any = false;
    const int parts = static_cast<int>(std::ceil(motion.step() / checked_step));
    const double step = motion.step() / parts;
    Place before = place(path, timed, motion, 0, 0.0);
    for (std::size_t i = 0; i + 1 < motion.points(); ++i) {
      for (int part = 1; part <= parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        const Place now = place(path, timed, motion, i, share);
        const Loads used = loads_between(std::exchange(before, now), now, step);
        if (used.most() <= 1.0 + 0.5 * spare_drive) continue;
        any = true;
        const double at = motion.path_time(i, share);
        for (std::size_t k = timed.cell_at(at - motion.reach());
             k <= timed.cell_at(at + motion.reach()); ++k) {
          loads[k].drive = std::max(loads[k].drive, used.drive);
          loads[k].torque = std::max(loads[k].torque, used.torque);
        }
      }
    }
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const Loads& load = loads[k];
      if (load.drive > 1.0)
        limits[k].squared = timed.largest_squared(k) / (load.drive * load.drive);
      if (load.torque > 1.0) limits[k].swing_torque /= load.torque;
    }
    return any;
  }

 private:
  /// Shares of the limits.
  struct Loads {
    double drive = 0.0;   ///< cylinders, flow and power
    double torque = 0.0;  ///< of the swing
    double most() const { return std::max(drive, torque); }
  };

  struct Place {
    FrontJoints joints;
    double payload;             ///< [kg]
    double rate, acceleration;  ///< of the swing
    DriveState drive;
  };

  Place place(const SmoothPath& path, const TimedPath& timed, const SmoothMotion& motion,
              std::size_t point, double share) const {
    const PathCell& cell = path.cells[timed.cell_at(motion.path_time(point, share))];
    const FrontJoints joints = motion.joints(point, share), rates = motion.rates(point, share);
    return {joints, cell.payload, rates[3], motion.accelerations(point, share)[3],
            DriveState(machine_, joints, rates, cell.torque)};
  }

  /// Up to the later place. Soil that is dumped takes its momentum along.
  Loads loads_between(const Place& a, const Place& b, double step) const {
    const double inertia = swing_.inertia(b.joints, b.payload);
    const double growth = (inertia - swing_.inertia(a.joints, b.payload)) / step;
    const double torque = inertia * b.acceleration + growth * b.rate;
    const double power = drive_.per_power() * std::max(0.0, torque * b.rate);
    return {drive_load(drive_, a.drive, b.drive).most(power), std::abs(torque) / swing_torque_};
  }

  const Machine& machine_;
  const DriveLimits& drive_;
  const SwingLoad& swing_;
  double swing_torque_;  // highest [N m]
};

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
  check_timing("MotionOptions", options.speed_fraction, options.corner_tolerance);
  require(options.max_jerk >= least_jerk, "MotionOptions::max_jerk", options.max_jerk,
          "at least " + number_text(least_jerk) + " rad/s^3");
}

Way way_of(const DigPath& path, const std::vector<JointAngles>& torques) {
  check_torques(path, torques.size());
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
  check_way(machine, way);
  const SmoothPath path = smooth_path(machine, way, options.corner_tolerance);
  const SwingLoad swing(machine, way);
  const FrontLimits limits(machine, path, swing, options.speed_fraction);
  const DriveLimits drive(machine, options.speed_fraction * (1.0 - spare_drive));
  const Smoothing smoothing(machine, options, limits.acceleration);
  std::vector<CellLimits> cells = limits_of(machine, path, limits, drive, swing);
  Profile profile(path, cells, smoothing.acceleration, drive.per_power());
  const MotionCheck check(machine, drive, swing, limits.swing_torque);
  for (int round = 0; round < most_rounds; ++round) {
    profile.run();
    const TimedPath timed(path, profile.squared());
    constexpr double longest = 3600.0;  // ours [s]
    require(timed.duration() <= longest, "duration of the motion [s]", timed.duration(),
            "at most " + number_text(longest));
    const SmoothMotion motion(timed, smoothing);
    if (check.lower(path, timed, motion, cells)) continue;
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
  refuse("no speed was found at which cylinders, power and swing of machine " + machine.name +
         " keep their limits on this way");
}

}  // namespace excavplan
