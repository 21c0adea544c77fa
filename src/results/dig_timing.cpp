// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "results/dig_timing.hpp"

#include <algorithm>
#include <cmath>

#include <excavplan/machine/trajectory.hpp>

namespace excavplan {
namespace {

double distance(const BucketPose& a, const BucketPose& b) {
  return std::hypot(b.x - a.x, b.z - a.z);
}

/// Travel of the tip up to each pose [m].
template <typename Poses>
std::vector<double> travels(const Poses& poses) {
  std::vector<double> sums = {0.0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    sums.push_back(sums.back() + distance(poses[i - 1].bucket, poses[i].bucket));
  }
  return sums;
}

std::size_t end_of_dig(const std::vector<DigPose>& poses) {
  const auto end = std::find_if(poses.begin(), poses.end(),
                                [](const DigPose& pose) { return pose.phase == DigPhase::lift; });
  return static_cast<std::size_t>(end - poses.begin());
}

/// Time within a segment of constant acceleration, `share` of its way along [-].
double share_of_time(double share, double first_speed, double last_speed) {
  const double sum = first_speed + last_speed;
  if (!(sum > 0.0) || share <= 0.0) return share;
  const double speed = std::sqrt(first_speed * first_speed +
                                 share * (last_speed * last_speed - first_speed * first_speed));
  return share * sum / (first_speed + speed);
}

/// Time of each pose of the dig [s]. Corners of the trajectory are rounded by a millimetre, so that
/// both are matched by the share of their way.
std::vector<double> times_of_poses(const Trajectory& trajectory,
                                   const std::vector<DigPose>& poses) {
  const std::vector<TrajectoryPoint>& points = trajectory.points;
  const std::vector<double> way = travels(points);
  const std::vector<double> pose_way = travels(poses);
  const std::size_t end = end_of_dig(poses);
  const auto last_point =
      std::find_if(points.begin(), points.end(),
                   [](const TrajectoryPoint& point) { return point.phase == DigPhase::lift; });
  const auto last = static_cast<std::size_t>(last_point - points.begin()) - 1;
  const double scale = way[last] / pose_way[end - 1];
  std::vector<double> times;
  std::size_t at = 1;
  for (std::size_t i = 0; i < end; ++i) {
    const double target = scale * pose_way[i];
    while (at < last && way[at] < target) ++at;
    const double step = way[at] - way[at - 1];
    const double share = step > 0.0 ? std::clamp((target - way[at - 1]) / step, 0.0, 1.0) : 1.0;
    const double part = share_of_time(share, points[at - 1].rates.norm(), points[at].rates.norm());
    times.push_back(points[at - 1].time + part * (points[at].time - points[at - 1].time));
  }
  return times;
}

}  // namespace

std::vector<TimedStep> timed_steps(const Machine& machine, const DigPath& path,
                                   const DigResult& dig) {
  if (dig.history.empty()) return {};
  const std::vector<DigPose>& poses = path.poses;
  DigPath alone = path;
  alone.approach.clear();
  const Trajectory trajectory = time_dig_path(machine, alone, {}, dig.torques);
  const std::vector<double> times = times_of_poses(trajectory, poses);
  std::vector<TimedStep> steps;
  for (std::size_t i = 0; i < dig.history.size() && i + 1 < times.size(); ++i) {
    const ForceSample& sample = dig.history[i];
    const double duration = times[i + 1] - times[i];
    const Eigen::Array3d work =
        sample.torque.array() * (poses[i + 1].joints - poses[i].joints).array();
    const double power = duration > 0.0 ? work.max(0.0).sum() / duration : 0.0;
    steps.push_back({sample.phase, 0.5 * (times[i] + times[i + 1]), duration, power});
  }
  return steps;
}

}  // namespace excavplan
