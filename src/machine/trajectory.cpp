// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <excavplan/error.hpp>

#include "../json_file.hpp"

namespace excavplan {
namespace {

constexpr double standstill = 1e-9;  // poses closer than this are one pose [rad]

struct Limits {
  JointAngles speed;
  JointAngles acceleration;
};

/// One stretch between two stops: points first .. last of the trajectory.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};

Limits usable_limits(const Machine& machine, double fraction) {
  Limits limits;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& joint = machine.limits[static_cast<std::size_t>(i)];
    limits.speed[i] = fraction * joint.speed;
    limits.acceleration[i] = fraction * joint.acceleration;
  }
  return limits;
}

void check(const DigPath& path, const TrajectoryOptions& options) {
  if (!(options.speed_fraction > 0.0 && options.speed_fraction <= 1.0)) {
    throw Error(ErrorKind::bad_input, "TrajectoryOptions::speed_fraction is " +
                                          number_text(options.speed_fraction) +
                                          ", must be above 0 and at most 1");
  }
  if (path.poses.size() < 2) {
    throw Error(ErrorKind::bad_input, "the dig path has " + std::to_string(path.poses.size()) +
                                          " poses, must have at least 2");
  }
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if (path.poses[i].joints.allFinite()) continue;
    throw Error(ErrorKind::bad_input,
                "pose " + std::to_string(i) + " of the dig path has a joint that is not finite");
  }
}

TrajectoryPoint point_at(const DigPose& pose) {
  TrajectoryPoint point;
  point.phase = pose.phase;
  point.joints = pose.joints;
  point.bucket = pose.bucket;
  return point;
}

TrajectoryPoint halfway(const Machine& machine, const DigPose& a, const DigPose& b) {
  DigPose between;
  between.phase = b.phase;
  between.joints = 0.5 * (a.joints + b.joints);
  between.bucket = forward_kinematics(machine, between.joints);
  return point_at(between);
}

/// The poses that move on, in order. A phase of a single step gets a point halfway, where it can
/// have a speed; between its two stops it would have none.
std::vector<TrajectoryPoint> points_of(const Machine& machine, const DigPath& path) {
  std::vector<DigPose> poses = {path.poses.front()};
  for (const DigPose& pose : path.poses) {
    if ((pose.joints - poses.back().joints).norm() > standstill) poses.push_back(pose);
  }
  if (poses.size() > 1) poses.front().phase = poses[1].phase;
  std::vector<TrajectoryPoint> points = {point_at(poses.front())};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const bool begins = i == 1 || poses[i].phase != poses[i - 1].phase;
    const bool ends = i + 1 == poses.size() || poses[i + 1].phase != poses[i].phase;
    if (begins && ends) points.push_back(halfway(machine, poses[i - 1], poses[i]));
    points.push_back(point_at(poses[i]));
  }
  return points;
}

std::vector<Stretch> stretches_of(const std::vector<TrajectoryPoint>& points) {
  std::vector<Stretch> stretches;
  std::size_t first = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (i + 1 < points.size() && points[i + 1].phase == points[i].phase) continue;
    stretches.push_back({first, i});
    first = i;
  }
  return stretches;
}

/// Time-optimal speed along the joint path q(s) of one stretch, s being its length in joint space
/// [rad]. The squared speed x is bounded at each point by the joint speeds and by the curvature
/// q''; then |q'' x| + |q' dx/(2 ds)| <= acceleration limits how fast it may grow, forwards, and
/// fall, backwards (Bobrow, Dubowsky and Gibson 1985, on a grid).
///
/// q' is taken from each segment and q'' from its change over half of both neighbours. With these,
/// rates and accelerations that a controller forms as differences of the samples, and those between
/// the stated rates, are averages of bounded terms: they keep the limits exactly, not nearly.
class Pass {
 public:
  Pass(std::vector<TrajectoryPoint>& points, const Stretch& stretch, const Limits& limits)
      : points_(points), first_(stretch.first), limits_(limits) {
    const std::size_t count = stretch.last - stretch.first;
    for (std::size_t k = 0; k < count; ++k) {
      const JointAngles move = joints(k + 1) - joints(k);
      length_.push_back(move.norm());
      slope_.push_back(move / length_.back());
    }
    tangent_.assign(count + 1, JointAngles::Zero());
    curvature_.assign(count + 1, JointAngles::Zero());
    for (std::size_t k = 1; k < count; ++k) {
      const double before = length_[k - 1], after = length_[k];
      tangent_[k] = (after * slope_[k - 1] + before * slope_[k]) / (before + after);
      curvature_[k] = 2.0 * (slope_[k] - slope_[k - 1]).cwiseAbs() / (before + after);
    }
  }

  /// Sets times (from the time of the first point on) and rates of the stretch.
  void run() {
    bound_speed();
    const std::size_t count = length_.size();
    for (std::size_t k = 0; k < count; ++k) limit_growth(k, k, k + 1);
    for (std::size_t k = count; k-- > 0;) limit_growth(k, k + 1, k);
    for (std::size_t k = 1; k <= count; ++k) {
      const double mean = 0.5 * (std::sqrt(squared_[k - 1]) + std::sqrt(squared_[k]));
      points_[first_ + k].time = points_[first_ + k - 1].time + length_[k - 1] / mean;
      points_[first_ + k].rates = tangent_[k] * std::sqrt(squared_[k]);
    }
  }

 private:
  const JointAngles& joints(std::size_t k) const { return points_[first_ + k].joints; }

  void bound_speed() {
    squared_.assign(length_.size() + 1, 0.0);
    for (std::size_t k = 1; k < length_.size(); ++k) {
      const JointAngles steepest = slope_[k - 1].cwiseAbs().cwiseMax(slope_[k].cwiseAbs());
      // The neighbours' curvature as well: else slowing down for it could break the growth behind.
      const JointAngles bend =
          curvature_[k - 1].cwiseMax(curvature_[k]).cwiseMax(curvature_[k + 1]);
      double bound = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 3; ++i) {
        if (steepest[i] > 0.0) bound = std::min(bound, std::pow(limits_.speed[i] / steepest[i], 2));
        if (bend[i] > 0.0) bound = std::min(bound, limits_.acceleration[i] / bend[i]);
      }
      squared_[k] = bound;
    }
  }

  /// Over one segment, from the point where the speed is known to be allowed to the other one.
  void limit_growth(std::size_t segment, std::size_t from, std::size_t to) {
    const JointAngles bend = curvature_[from].cwiseMax(curvature_[to]);
    for (int i = 0; i < 3; ++i) {
      const double gain = std::abs(slope_[segment][i]) / (2.0 * length_[segment]);
      if (gain <= 0.0) continue;
      const double highest = (limits_.acceleration[i] + gain * squared_[from]) / (gain + bend[i]);
      squared_[to] = std::min(squared_[to], highest);
    }
  }

  std::vector<TrajectoryPoint>& points_;
  std::size_t first_;
  const Limits& limits_;
  std::vector<double> length_;          // of each segment [rad]
  std::vector<JointAngles> slope_;      // dq/ds of each segment
  std::vector<JointAngles> tangent_;    // dq/ds at each point
  std::vector<JointAngles> curvature_;  // |d²q/ds²| at each point [1/rad]
  std::vector<double> squared_;         // (ds/dt)² at each point
};

}  // namespace

double Trajectory::dig_duration() const {
  double begin = 0.0, end = 0.0;
  for (const TrajectoryPoint& point : points) {
    if (point.phase == DigPhase::approach) begin = point.time;
    if (point.phase != DigPhase::lift) end = point.time;
  }
  return end - begin;
}

Trajectory time_dig_path(const Machine& machine, const DigPath& path,
                         const TrajectoryOptions& options) {
  check(path, options);
  const Limits limits = usable_limits(machine, options.speed_fraction);
  Trajectory trajectory;
  trajectory.points = points_of(machine, path);
  for (const Stretch& stretch : stretches_of(trajectory.points)) {
    Pass(trajectory.points, stretch, limits).run();
  }
  return trajectory;
}

std::string to_csv(const Trajectory& trajectory) {
  std::string csv = "time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad\n";
  for (const TrajectoryPoint& point : trajectory.points) {
    csv += number_text(point.time) + ',' + name(point.phase);
    for (const double value : {point.joints[0], point.joints[1], point.joints[2], point.bucket.x,
                               point.bucket.z, point.bucket.floor_angle}) {
      csv += ',' + number_text(value);
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace excavplan
