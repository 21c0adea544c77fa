// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "machine/corner_rules.hpp"
#include "machine/drive_limits.hpp"

namespace excavplan {
namespace {

// Ours, of the rounding of a corner, along the joint path to either side [rad]:
constexpr double longest_reach = 0.02;
constexpr int steps_a_side = 4;
constexpr double room_share = 0.4;  // of a phase that the rounding of one corner may take

/// Larger angles and torques are not those of a machine and could overflow; ours.
constexpr double largest_angle = 100.0;  // [rad]
constexpr double largest_torque = 1e12;  // [N m]

bool within(const JointAngles& values, double largest) {
  return (values.array().abs() <= largest).all();
}

std::string excess(const JointAngles& values, const std::string& largest) {
  return values.allFinite() ? "beyond " + largest : "not finite";
}

void check(const DigPath& path, const TrajectoryOptions& options,
           const std::vector<JointAngles>& torques) {
  check_timing("TrajectoryOptions", options.speed_fraction, options.corner_tolerance);
  check_torques(path, torques.size());
  const auto check_finite = [](const std::vector<DigPose>& poses, const char* of_what) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (within(poses[i].joints, largest_angle)) continue;
      refuse("pose " + std::to_string(i) + " of the " + of_what + " has a joint that is " +
             excess(poses[i].joints, number_text(largest_angle) + " rad"));
    }
  };
  check_finite(path.approach, "approach");
  check_finite(path.poses, "dig path");
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (within(torques[i], largest_torque)) continue;
    refuse("torque " + std::to_string(i) + " is " +
           excess(torques[i], number_text(largest_torque) + " N m"));
  }
}

// ---- geometry of the trajectory -----------------------------------------------------------------

TrajectoryPoint point_at(const DigPose& pose) {
  TrajectoryPoint point;
  point.phase = pose.phase;
  point.joints = pose.joints;
  point.bucket = pose.bucket;
  return point;
}

/// A pose and the torques of the joints on the way to it [N m].
struct LoadedPose : DigPose {
  JointAngles torque = JointAngles::Zero();
};

/// The poses of approach and dig with motion. A pose between two phases belongs to the earlier one.
std::vector<LoadedPose> moving_poses(const DigPath& path, const std::vector<JointAngles>& torques) {
  std::vector<LoadedPose> poses;
  poses.reserve(path.approach.size() + path.poses.size());
  const auto add = [&](const DigPose& pose, const JointAngles& torque) {
    if (poses.empty() || (pose.joints - poses.back().joints).norm() > standstill) {
      poses.push_back({pose, torque});
    }
  };
  for (const DigPose& pose : path.approach) add(pose, JointAngles::Zero());
  add(path.poses.front(), JointAngles::Zero());
  if (!path.approach.empty()) poses.back().phase = path.approach.back().phase;
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    add(path.poses[i], i <= torques.size() ? torques[i - 1] : JointAngles::Zero());
  }
  if (poses.size() > 1) poses.front().phase = poses[1].phase;
  return poses;
}

/// The pose between two phases, at the length `along` of the joint path.
struct Corner {
  std::size_t pose = 0;
  double along = 0.0;
  JointAngles turn = JointAngles::Zero();  ///< of the unit direction of the joints
  double reach = 0.0;                      ///< of its rounding to either side; 0: a stop [rad]
};

/// The points of the trajectory: the poses, and rounded corners. At a corner the path q(s) gets
/// turn · (reach - |s|)² / (4 reach) added, s counted from the corner: a parabola, which leaves the
/// path by at most turn · reach / 4, and whose curvature is turn / (2 reach).
class Route {
 public:
  Route(const Machine& machine, const DigPath& path, const std::vector<JointAngles>& torques,
        double tolerance)
      : machine_(machine), poses_(moving_poses(path, torques)) {
    along_.reserve(poses_.size());
    along_.push_back(0.0);
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      along_.push_back(along_.back() + (poses_[i].joints - poses_[i - 1].joints).norm());
    }
    find_corners(tolerance);
    lay_out();
  }

  std::vector<TrajectoryPoint> take_points() { return std::move(points_); }
  /// Of the joints on the way to each point [N m].
  const std::vector<JointAngles>& torques() const { return torques_; }
  /// Points where the machine rests: the first, the last, and those it stops at between.
  const std::vector<std::size_t>& stops() const { return stops_; }

 private:
  void find_corners(double tolerance);
  double reach_at(const Corner& corner, double tolerance) const;
  void lay_out();
  void stop_at(std::size_t pose);
  void add_rounding(const Corner& corner);
  void add_faster_point(double slow_begin, DigPhase phase);
  void end_slow_place(double along);
  std::size_t pose_after(double along) const;
  JointAngles joints_at(double along) const;
  void add_pose(std::size_t pose);
  void add_point(DigPhase phase, const JointAngles& joints, double along);
  void add_torque(double along);

  const Machine& machine_;
  std::vector<LoadedPose> poses_;
  std::vector<double> along_;  // of each pose [rad]
  std::vector<Corner> corners_;
  std::vector<TrajectoryPoint> points_;
  std::vector<JointAngles> torques_;
  double torques_end_ = 0.0;  // along the path [rad]
  std::vector<std::size_t> stops_;
  std::size_t slow_points_ = 0;  // up to the end of the last slow place: a stop or a rounding
  double slow_end_ = 0.0;        // where it ends along the path [rad]
};

void Route::find_corners(double tolerance) {
  for (std::size_t i = 1; i + 1 < poses_.size(); ++i) {
    if (poses_[i + 1].phase == poses_[i].phase) continue;
    corners_.emplace_back();
    corners_.back().pose = i;
    corners_.back().along = along_[i];
  }
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    Corner& corner = corners_[c];
    const double begin = c == 0 ? 0.0 : corners_[c - 1].along;
    const double end = c + 1 == corners_.size() ? along_.back() : corners_[c + 1].along;
    const JointAngles& at = poses_[corner.pose].joints;
    const JointAngles before = (at - poses_[corner.pose - 1].joints).normalized();
    const JointAngles after = (poses_[corner.pose + 1].joints - at).normalized();
    corner.turn = after - before;
    if (before.dot(after) < sharpest_turn) continue;
    const double room = room_share * std::min(corner.along - begin, end - corner.along);
    const double deviation = 0.25 * bucket_motion(machine_, at, corner.turn);
    const double reach = std::min({longest_reach, room, tolerance / deviation});
    if (reach >= shortest_reach) corner.reach = reach;
  }
}

void Route::lay_out() {
  constexpr double spacing = 1.25;  // no pose is kept nearer than this to the corner [reach]
  const std::size_t most = poses_.size() + (2 * steps_a_side + 1) * corners_.size() + 1;
  points_.reserve(most);
  torques_.reserve(most);
  stop_at(0);
  std::size_t i = 1;
  for (const Corner& corner : corners_) {
    while (i < corner.pose && along_[i] < corner.along - spacing * corner.reach) {
      add_pose(i++);
    }
    if (corner.reach > 0.0) {
      add_rounding(corner);
    } else {
      stop_at(corner.pose);
    }
    i = corner.pose + 1;
    while (along_[i] < corner.along + spacing * corner.reach) ++i;
  }
  while (i + 1 < poses_.size()) add_pose(i++);
  if (i < poses_.size()) stop_at(i);
}

void Route::stop_at(std::size_t pose) {
  add_faster_point(along_[pose], poses_[pose].phase);
  stops_.push_back(points_.size());
  add_pose(pose);
  end_slow_place(along_[pose]);
}

void Route::add_rounding(const Corner& corner) {
  add_faster_point(corner.along - corner.reach, poses_[corner.pose].phase);
  for (int step = -steps_a_side; step <= steps_a_side; ++step) {
    const double share = static_cast<double>(step) / steps_a_side;
    const double off_path = 0.25 * corner.reach * (1.0 - std::abs(share)) * (1.0 - std::abs(share));
    const double along = corner.along + share * corner.reach;
    add_point(poses_[share > 0.0 ? corner.pose + 1 : corner.pose].phase,
              joints_at(along) + off_path * corner.turn, along);
  }
  end_slow_place(corner.along + corner.reach);
}

/// Between two slow places there is always a point that can be faster: alone, a segment from one to
/// the other would be driven as slowly as they are.
void Route::add_faster_point(double slow_begin, DigPhase phase) {
  if (points_.empty() || points_.size() > slow_points_) return;
  const double along = 0.5 * (slow_end_ + slow_begin);
  add_point(phase, joints_at(along), along);
}

void Route::end_slow_place(double along) {
  slow_points_ = points_.size();
  slow_end_ = along;
}

/// The pose at the end of the stretch that holds this place.
std::size_t Route::pose_after(double along) const {
  const auto end = std::lower_bound(along_.begin() + 1, along_.end() - 1, along);
  return static_cast<std::size_t>(end - along_.begin());
}

/// Of the path, between its poses.
JointAngles Route::joints_at(double along) const {
  const std::size_t to = pose_after(along);
  const double part = (along - along_[to - 1]) / (along_[to] - along_[to - 1]);
  return poses_[to - 1].joints + part * (poses_[to].joints - poses_[to - 1].joints);
}

void Route::add_pose(std::size_t pose) {
  points_.push_back(point_at(poses_[pose]));
  add_torque(along_[pose]);
}

void Route::add_point(DigPhase phase, const JointAngles& joints, double along) {
  DigPose pose;
  pose.phase = phase;
  pose.joints = joints;
  pose.bucket = forward_kinematics(machine_, joints);
  points_.push_back(point_at(pose));
  add_torque(along);
}

/// That of the stretch in which the way from the last point to this one has its middle.
void Route::add_torque(double along) {
  const double middle = 0.5 * (torques_end_ + along);
  torques_.push_back(poses_.size() > 1 ? poses_[pose_after(middle)].torque : JointAngles::Zero());
  torques_end_ = along;
}

// ---- how fast -----------------------------------------------------------------------------------

/// Time-optimal speed along the joint path q(s) between two stops, s being its length in joint
/// space [rad]. The squared speed x is bounded at each point by the speeds of joints and cylinders,
/// by the flow and by the curvature q''; then |q'' x| + |q' dx/(2 ds)| <= acceleration limits how
/// fast it may grow, forwards, and fall, backwards (Bobrow, Dubowsky and Gibson 1985, on a grid).
///
/// q' is taken from each segment and q'' from its change over half of both neighbours. With these,
/// rates and accelerations that a controller forms as differences of the samples, and those between
/// the stated rates, are averages of bounded terms: they keep the limits exactly. So do the speeds
/// of the cylinders: each segment is bounded by its levers at both ends and by its mean.
class Pass {
 public:
  Pass(std::vector<TrajectoryPoint>& points, const std::vector<JointAngles>& torques,
       const std::optional<Cylinders>& cylinders, const DriveLimits& limits)
      : points_(points),
        torques_(torques),
        limits_(limits),
        segments_(points.size()),
        nodes_(points.size()) {
    if (cylinders) place_cylinders(*cylinders);
  }

  /// Sets times (from the time of the first point on) and rates between two stops.
  void run(std::size_t first, std::size_t last) {
    measure(first, last);
    bound_speed(first, last);
    for (std::size_t k = first; k < last; ++k) {
      limit_growth(segments_[k], nodes_[k], nodes_[k + 1]);
    }
    for (std::size_t k = last; k-- > first;) {
      limit_growth(segments_[k], nodes_[k + 1], nodes_[k]);
    }
    double speed_before = 0.0;
    for (std::size_t k = first + 1; k <= last; ++k) {
      const double speed = std::sqrt(nodes_[k].squared);
      const double mean = 0.5 * (std::exchange(speed_before, speed) + speed);
      points_[k].time = points_[k - 1].time + segments_[k - 1].length / mean;
      points_[k].rates = nodes_[k].tangent * speed;
    }
    for (std::size_t k = first; k <= last; ++k) {
      points_[k].cylinder_speeds =
          nodes_[k].levers.cwiseProduct(points_[k].rates).array() + 0.0;  // no negative zero
    }
  }

 private:
  /// From a point to the next.
  struct Segment {
    double length = 0.0;  ///< [rad]
    double per_length = 0.0;
    JointAngles slope;     ///< dq/ds
    JointAngles gain;      ///< |dq/ds| / (2 ds)
    JointAngles per_drag;  ///< 1 / (gain + curvature); infinite for a joint that rests
    double ceiling = 0.0;  ///< of ds/dt, from the speeds of joints and cylinders and the flow
  };
  struct Node {
    JointAngles tangent = JointAngles::Zero();    ///< dq/ds
    JointAngles curvature = JointAngles::Zero();  ///< |d²q/ds²| [1/rad]
    double squared = 0.0;                         ///< (ds/dt)²
    /// d length / dq of the cylinders [m/rad]
    Eigen::Vector3d levers = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  };

  /// A cylinder keeps its state where its joint rests.
  void place_cylinders(const Cylinders& cylinders) {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      for (int i = 0; i < 3; ++i) {
        if (k > 0 && points_[k].joints[i] == points_[k - 1].joints[i]) {
          points_[k].cylinders[i] = points_[k - 1].cylinders[i];
          nodes_[k].levers[i] = nodes_[k - 1].levers[i];
        } else {
          const CylinderState state =
              cylinders[static_cast<std::size_t>(i)].at(points_[k].joints[i]);
          points_[k].cylinders[i] = state.length;
          nodes_[k].levers[i] = state.lever;
        }
      }
    }
  }

  void measure(std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Segment& segment = segments_[k];
      const JointAngles move = points_[k + 1].joints - points_[k].joints;
      segment.length = move.norm();
      segment.per_length = 1.0 / segment.length;
      segment.slope = move * segment.per_length;
      segment.gain = segment.slope.cwiseAbs() * (0.5 * segment.per_length);
      segment.ceiling = ceiling_of(k);
    }
    nodes_[first].curvature = nodes_[last].curvature = JointAngles::Zero();
    for (std::size_t k = first + 1; k < last; ++k) {
      const Segment &before = segments_[k - 1], &after = segments_[k];
      const double per_both = 1.0 / (before.length + after.length);
      nodes_[k].tangent = (after.length * before.slope + before.length * after.slope) * per_both;
      nodes_[k].curvature = (after.slope - before.slope).cwiseAbs() * (2.0 * per_both);
    }
  }

  double ceiling_of(std::size_t k) const {
    const JointAngles &slope = segments_[k].slope, &torque = torques_[k + 1];
    const Eigen::Vector3d &levers = nodes_[k].levers, &next = nodes_[k + 1].levers;
    const Eigen::Vector3d mean =
        (points_[k + 1].cylinders - points_[k].cylinders) * segments_[k].per_length;
    const double pressure =
        std::max(limits_.pressure(torque, slope, levers), limits_.pressure(torque, slope, next));
    const double load = std::max({limits_.load(slope), limits_.power_load(torque, slope),
                                  limits_.cylinder_load(mean, pressure),
                                  limits_.cylinder_load(levers.cwiseProduct(slope), pressure),
                                  limits_.cylinder_load(next.cwiseProduct(slope), pressure)});
    return 1.0 / load;
  }

  void bound_speed(std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const JointAngles bend = nodes_[k].curvature.cwiseMax(nodes_[k + 1].curvature);
      segments_[k].per_drag = (segments_[k].gain + bend).cwiseInverse();
    }
    nodes_[first].squared = nodes_[last].squared = 0.0;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double ceiling = std::min(segments_[k - 1].ceiling, segments_[k].ceiling);
      // The neighbours' curvature as well: else slowing down for it could break the growth behind.
      const JointAngles bend =
          nodes_[k - 1].curvature.cwiseMax(nodes_[k].curvature).cwiseMax(nodes_[k + 1].curvature);
      nodes_[k].squared = ceiling * ceiling;
      for (int i = 0; i < 3; ++i) {
        if (bend[i] <= 0.0) continue;
        nodes_[k].squared = std::min(nodes_[k].squared, limits_.acceleration()[i] / bend[i]);
      }
    }
  }

  /// Over one segment, from the point of known speed to the other one.
  void limit_growth(const Segment& segment, const Node& from, Node& to) const {
    const JointAngles highest =
        (limits_.acceleration() + segment.gain * from.squared).cwiseProduct(segment.per_drag);
    to.squared = std::min(to.squared, highest.minCoeff());
  }

  std::vector<TrajectoryPoint>& points_;
  const std::vector<JointAngles>& torques_;  // on the way to each point
  const DriveLimits& limits_;
  std::vector<Segment> segments_;
  std::vector<Node> nodes_;
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
                         const TrajectoryOptions& options,
                         const std::vector<JointAngles>& torques) {
  require_machine(machine);
  check(path, options, torques);
  Route route(machine, path, torques, options.corner_tolerance);
  Trajectory trajectory;
  trajectory.machine = machine.name;
  trajectory.robot_joints = machine.robot_joints;
  trajectory.points = route.take_points();
  const DriveLimits limits(machine, options.speed_fraction);
  Pass pass(trajectory.points, route.torques(), machine.cylinders, limits);
  const std::vector<std::size_t>& stops = route.stops();
  for (std::size_t i = 1; i < stops.size(); ++i) pass.run(stops[i - 1], stops[i]);
  require(std::isfinite(trajectory.duration()), "duration of the trajectory", trajectory.duration(),
          "finite");
  return trajectory;
}

}  // namespace excavplan
