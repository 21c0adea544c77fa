// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/motion_path.hpp"

#include <algorithm>
#include <cmath>

#include "machine/corner_rules.hpp"

namespace excavplan {
namespace {

// Ours:
constexpr double corner_turn = 0.2;     // a smaller turn within a phase is no corner [rad]
constexpr double least_rounded = 1e-3;  // at what is no corner [m]
constexpr double longest_cell = 0.01;   // [rad]

class PathLayout {
 public:
  PathLayout(const Machine& machine, const Way& way, double tolerance)
      : machine_(machine), tolerance_(tolerance) {
    for (const WayPose& pose : way.poses) {
      if (poses_.empty() || (pose.joints - poses_.back().joints).norm() > standstill) {
        poses_.push_back(pose);
      }
    }
  }

  SmoothPath path() {
    double reach = 0.0;  // of the rounding at the begin of the segment
    path_.stops.push_back(0);
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      const FrontJoints move = poses_[i].joints - poses_[i - 1].joints;
      const FrontJoints slope = move.normalized();
      const double next = i + 1 < poses_.size() ? reach_at(i) : 0.0;
      if (reach > 0.0) add_half(i, slope, reach, poses_[i - 1].joints, 0.0);
      const double straight = move.norm() - reach - next;
      if (straight > standstill) {
        add(poses_[i], poses_[i - 1].joints + reach * slope, slope, FrontJoints::Zero(), straight);
      }
      if (next > 0.0) add_half(i, slope, next, poses_[i].joints, -next);
      if (next == 0.0) path_.stops.push_back(path_.cells.size());
      reach = next;
    }
    return std::move(path_);
  }

 private:
  FrontJoints direction(std::size_t to) const {
    return (poses_[to].joints - poses_[to - 1].joints).normalized();
  }

  /// Half of the parabola q(s) = pose + s·mean + turn·(s² + reach²)/(4 reach), |s| <= reach, about
  /// the begin (from = 0) or the end (from = -reach) of a segment.
  void add_half(std::size_t segment, const FrontJoints& slope, double reach,
                const FrontJoints& corner, double from) {
    const bool first = from < 0.0;
    const FrontJoints other = direction(first ? segment + 1 : segment - 1);
    const FrontJoints turn = first ? FrontJoints(other - slope) : FrontJoints(slope - other);
    const FrontJoints mean = 0.5 * (slope + other), bend = turn / (2.0 * reach);
    const FrontJoints begin =
        corner + from * mean + (from * from + reach * reach) / (4.0 * reach) * turn;
    add(poses_[segment], begin, mean + from * bend, bend, reach);
  }

  /// In cells; at least two, so that between two rests one end of a cell always moves.
  void add(const WayPose& to, const FrontJoints& begin, const FrontJoints& slope,
           const FrontJoints& bend, double length) {
    const double cells = std::max(2.0, std::ceil(length / longest_cell));
    PathCell cell = {length / cells, begin, slope, bend, to.phase, to.torque, to.payload};
    for (double i = 0.0; i < cells; ++i) {
      path_.cells.push_back(cell);
      cell.begin = cell.at(cell.length);
      cell.slope = cell.last_slope();
    }
  }

  double reach_at(std::size_t pose) const {
    const FrontJoints before = direction(pose), after = direction(pose + 1);
    const double cosine = before.dot(after);
    if (cosine < sharpest_turn) return 0.0;
    const bool corner =
        poses_[pose].phase != poses_[pose + 1].phase || cosine < std::cos(corner_turn);
    const double tolerance = corner ? tolerance_ : std::max(tolerance_, least_rounded);
    const double room = 0.5 * std::min((poses_[pose].joints - poses_[pose - 1].joints).norm(),
                                       (poses_[pose + 1].joints - poses_[pose].joints).norm());
    const FrontJoints turn = after - before;
    const double deviation =
        0.25 * bucket_motion(machine_, poses_[pose].joints.head<3>(), turn.head<3>(), turn[3]);
    const double reach = deviation > 0.0 ? std::min(room, tolerance / deviation) : room;
    return reach < std::min(shortest_reach, room) ? 0.0 : reach;
  }

  const Machine& machine_;
  double tolerance_;
  std::vector<WayPose> poses_;
  SmoothPath path_;
};

}  // namespace

SmoothPath smooth_path(const Machine& machine, const Way& way, double tolerance) {
  return PathLayout(machine, way, tolerance).path();
}

}  // namespace excavplan
