// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/machine/dig_path.hpp>

namespace excavplan {

struct TrajectoryPoint {
  double time = 0.0;  ///< [s], starts at 0, strictly increasing
  DigPhase phase = DigPhase::penetrate;
  JointAngles joints = JointAngles::Zero();
  JointAngles rates = JointAngles::Zero();  ///< [rad/s]
  BucketPose bucket;
};

/// What the machine executes.
struct Trajectory {
  std::vector<TrajectoryPoint> points;
  double duration() const { return points.empty() ? 0.0 : points.back().time; }
  double dig_duration() const;  ///< of penetrate, drag and scoop [s]
};

struct TrajectoryOptions {
  double speed_fraction =
      0.8;  ///< of the joint speed and acceleration limits that is used, in (0, 1]
};

/// Times a path as fast as the joint speeds and accelerations allow, by a forward and a backward
/// pass over its poses, with a stop at every change of phase, where the direction of the joints
/// jumps. Differences of the samples keep the limits exactly.
///
/// The points are the poses of the path, but for poses that do not move (left out) and phases of a
/// single step (which get a point halfway).
///
/// @throws Error (bad_input) if the option is out of range or the path has fewer than two poses
Trajectory time_dig_path(const Machine& machine, const DigPath& path,
                         const TrajectoryOptions& options = {});

/// CSV with the columns time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m,bucket_angle_rad,
/// the last being the floor angle. Numbers do not obey the locale.
std::string to_csv(const Trajectory& trajectory);

}  // namespace excavplan
