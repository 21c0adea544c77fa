// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/live_scan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "recording/frame_average.hpp"

namespace excavplan {
namespace {

bool same_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double least_shift = 0.01, least_turn = 0.00175;  // [m, rad], as TransformTree::moved()
  const Eigen::Isometry3d between = a.inverse() * b;
  return between.translation().norm() <= least_shift &&
         Eigen::AngleAxisd(between.rotation()).angle() <= least_turn;
}

bool stood_still(const std::vector<LiveFrame>& frames) {
  return std::all_of(frames.begin(), frames.end(), [&](const LiveFrame& frame) {
    return frame.points.size == frames.front().points.size &&
           same_pose(*frame.pose, *frames.front().pose);
  });
}

/// Empty if the frames cannot be averaged.
std::vector<Eigen::Vector3d> average(const std::vector<LiveFrame>& frames) {
  if (!stood_still(frames) || frames.front().points.size.height < 2) return {};
  FrameAverage sum;
  for (const LiveFrame& frame : frames) {
    if (!sum.add(frame.points.points)) return {};
  }
  return sum.result().points;
}

void put(const Eigen::Isometry3d& pose, std::vector<Eigen::Vector3d>& points) {
  for (Eigen::Vector3d& point : points) point = pose * point;
}

void join(const std::vector<LiveFrame>& frames, std::vector<Eigen::Vector3d>& all) {
  for (const LiveFrame& frame : frames) {
    std::vector<Eigen::Vector3d> points = frame.points.points;
    put(*frame.pose, points);
    std::copy_if(points.begin(), points.end(), std::back_inserter(all),
                 [](const Eigen::Vector3d& point) { return point.allFinite(); });
  }
}

}  // namespace

LiveScan merged(const std::vector<LiveFrame>& frames) {
  LiveScan scan;
  Cloud& cloud = scan.cloud;
  const LiveFrame& first = frames.front();
  cloud.points = frames.size() == 1 ? first.points.points : average(frames);
  cloud.width = first.points.size.width;
  cloud.height = first.points.size.height;
  if (cloud.points.empty()) {
    join(frames, cloud.points);
    cloud.width = cloud.points.size();
    cloud.height = 1;
  } else {
    scan.averaged = frames.size() > 1;
    put(*first.pose, cloud.points);
  }
  if (first.from_sensor && stood_still(frames)) cloud.sensor_origin = first.pose->translation();
  return scan;
}

double seconds_of(const std::vector<LiveFrame>& frames) {
  std::int64_t newest = 0;
  for (const LiveFrame& frame : frames) newest = std::max(newest, frame.time);
  if (newest > 0) return 1e-9 * static_cast<double>(newest);
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_1970).count();
}

Scan without_machine(Scan scan) {
  if (!scan.machine) return scan;
  const Eigen::Isometry3d to_machine(scan.site_from_scan);
  for (std::shared_ptr<const Cloud>& cloud : scan.clouds) {
    auto rest = std::make_shared<Cloud>(*cloud);
    for (Eigen::Vector3d& point : rest->points) {
      if (scan.machine->holds(to_machine * point)) point.setConstant(std::nan(""));
    }
    cloud = std::move(rest);
  }
  scan.machine = nullptr;
  return scan;
}

}  // namespace excavplan
