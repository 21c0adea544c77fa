// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "trial/tracked_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.hpp"
#include "base/check.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr double correlation = 0.5;        // length [m]
constexpr double node = 0.25;              // [m]; ours
constexpr double share_of_variance = 0.5;  // of the error along the path, and of that of the dig
constexpr double most_turn = 0.35;         // of the bucket, to keep its heel clear [rad]; ours
constexpr int samples = 12;                // of its outline behind the tip

/// Way of the tip up to each pose; the lift does not count.
std::vector<double> travels(const DigPath& path) {
  std::vector<double> all = {0.0};
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const BucketPose &from = path.poses[i - 1].bucket, &to = path.poses[i].bucket;
    const bool digs = path.poses[i].phase != DigPhase::lift;
    all.push_back(all.back() + (digs ? std::hypot(to.x - from.x, to.z - from.z) : 0.0));
  }
  return all;
}

bool cuts(const DigPose& pose) {
  return pose.phase == DigPhase::penetrate || pose.phase == DigPhase::drag;
}

class Tracking {
 public:
  Tracking(const Machine& machine, DigPath& path)
      : machine_(machine_for_planned_path(machine)), beta_(machine.beta()), path_(path) {}

  void shift(const std::vector<double>& by) {
    for (std::size_t i = 0; i < by.size(); ++i) {
      const double planned = path_.poses[i].bucket.z;
      for (int eighths = 8; eighths > 0; --eighths) {
        BucketPose wanted = path_.poses[i].bucket;
        wanted.z = planned + by[i] * eighths / 8.0;
        if (take(i, wanted)) break;
      }
    }
  }

  /// Prepends poses along the first line until the tip is above the ground.
  void come_from_above(const GroundProfile& ground) {
    constexpr double step = 0.025, longest = 0.4, flattest = 0.5;  // ours [m], [rad]
    DigPose first = path_.poses.front();
    const BucketPose& next = path_.poses[1].bucket;
    const double down = std::atan2(first.bucket.z - next.z, first.bucket.x - next.x);
    const double angle = std::clamp(down, flattest, 0.5 * pi);
    first.phase = DigPhase::penetrate;
    std::vector<DigPose> before;
    for (double way = step; way <= longest; way += step) {
      const BucketPose& last = before.empty() ? first.bucket : before.back().bucket;
      if (!(last.z < ground(last.x))) break;
      DigPose pose = first;
      pose.bucket.x += way * std::cos(angle);
      pose.bucket.z += way * std::sin(angle);
      const auto joints = inverse_kinematics(machine_, pose.bucket);
      if (!std::holds_alternative<JointAngles>(joints)) break;
      pose.joints = std::get<JointAngles>(joints);
      before.push_back(pose);
    }
    path_.poses.insert(path_.poses.begin(), before.rbegin(), before.rend());
  }

  /// Turns the bucket; what it is turned by at the end of the drag fades over the scoop.
  void keep_heel_clear() {
    double turn = 0.0;
    for (std::size_t i = 0; i < path_.poses.size(); ++i) {
      if (cuts(path_.poses[i])) {
        turn = least_turn(i);
      } else {
        turn *= path_.poses[i].phase == DigPhase::scoop ? fading : 0.0;
      }
      if (turn < 1e-4) continue;
      BucketPose wanted = path_.poses[i].bucket;
      wanted.floor_angle += turn;
      take(i, wanted);
    }
  }

 private:
  static constexpr double fading = 0.8;  // from pose to pose

  bool take(std::size_t i, const BucketPose& wanted) {
    const auto joints = inverse_kinematics(machine_, wanted);
    if (!std::holds_alternative<JointAngles>(joints)) return false;
    path_.poses[i].bucket = wanted;
    path_.poses[i].joints = std::get<JointAngles>(joints);
    return true;
  }

  double least_turn(std::size_t i) const {
    if (is_clear(i, 0.0)) return 0.0;
    double low = 0.0, high = most_turn;
    for (int halvings = 0; halvings < 20; ++halvings) {
      const double middle = 0.5 * (low + high);
      (is_clear(i, middle) ? high : low) = middle;
    }
    return high;
  }

  /// Whether the outline behind the tip lies above what the tip has cut until then.
  bool is_clear(std::size_t i, double turn) const {
    const BucketPose& at = path_.poses[i].bucket;
    const double phi3 = at.floor_angle + turn - pi + beta_;
    const Vector2d along(std::cos(phi3), std::sin(phi3)), across(-along.y(), along.x());
    const auto& profile = machine_.bucket.profile;
    const double sides = std::min<double>(2.0, static_cast<double>(profile.size()) - 1.0);
    std::size_t behind = i;
    for (int k = 1; k <= samples; ++k) {
      const double where = sides * k / samples;
      const auto side = std::min<std::size_t>(static_cast<std::size_t>(where), profile.size() - 2);
      const double share = where - static_cast<double>(side);
      const Vector2d corner = profile[side] + share * (profile[side + 1] - profile[side]);
      const Vector2d off = corner - profile.front();
      const Vector2d point = Vector2d(at.x, at.z) + off.x() * along + off.y() * across;
      if (point.x() > at.x && point.y() < cut_at(point.x(), behind)) return false;
    }
    return true;
  }

  /// Height that the tip had at x before pose `behind`, which becomes the pose from where it went
  /// there; -infinity where it was not.
  double cut_at(double x, std::size_t& behind) const {
    const auto& poses = path_.poses;
    while (behind > 0 && poses[behind].bucket.x < x) --behind;
    const BucketPose& far = poses[behind].bucket;
    if (far.x < x || behind + 1 >= poses.size()) return -std::numeric_limits<double>::infinity();
    const BucketPose& near = poses[behind + 1].bucket;
    const double way = far.x - near.x;
    const double share = way > 0.0 ? std::clamp((x - near.x) / way, 0.0, 1.0) : 1.0;
    return near.z + share * (far.z - near.z);
  }

  Machine machine_;
  double beta_;
  DigPath& path_;
};

}  // namespace

std::vector<double> height_errors(const DigPath& path, const HiddenErrors& errors, Random& random) {
  const double sd = errors.height_sd * std::sqrt(share_of_variance);
  const double of_dig = errors.height_bias + sd * random.normal();
  const std::vector<double> travel = travels(path);
  const double kept = std::exp(-node / correlation);
  std::vector<double> nodes = {sd * random.normal()};
  while (static_cast<double>(nodes.size() - 1) * node <= travel.back()) {
    nodes.push_back(kept * nodes.back() + sd * std::sqrt(1.0 - kept * kept) * random.normal());
  }
  std::vector<double> all;
  for (const double at : travel) {
    const auto i = static_cast<std::size_t>(at / node);
    const double share = at / node - static_cast<double>(i);
    all.push_back(of_dig + (1.0 - share) * nodes[i] + share * nodes[i + 1]);
  }
  return all;
}

DigPath tracked_path(const Machine& machine, DigPath path, const std::vector<double>& shift,
                     const GroundProfile& ground) {
  require(path.poses.size() >= 2, "path: has fewer than two poses");
  require(shift.size() == path.poses.size(), "shift of a path: must be one for each pose");
  Tracking tracking(machine, path);
  tracking.shift(shift);
  tracking.come_from_above(ground);
  tracking.keep_heel_clear();
  return path;
}

}  // namespace excavplan
