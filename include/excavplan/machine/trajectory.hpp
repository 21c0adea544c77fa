// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
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
  /// Of boom, arm and bucket, pin to pin [m], and how fast they grow [m/s]; NaN if the machine does
  /// not state its cylinders.
  Eigen::Vector3d cylinders = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d cylinder_speeds = cylinders;
};

/// What the machine executes.
struct Trajectory {
  std::string machine;  ///< its name
  std::vector<TrajectoryPoint> points;
  double duration() const { return points.empty() ? 0.0 : points.back().time; }
  double dig_duration() const;  ///< of penetrate, drag and scoop [s]
};

struct TrajectoryOptions {
  /// Of the limits of joint speed, joint acceleration, cylinder speed and pump flow that is used,
  /// in (0, 1].
  double speed_fraction = 0.8;
  /// How far the tip may leave the path to round the corner between two phases [m], in 0 .. 0.01;
  /// the bucket's attitude may leave it by as much over the length of the bucket. 0: it stops
  /// there.
  double corner_tolerance = 0.001;
};

/// Times a path as fast as joint speeds, joint accelerations, cylinder speeds and the flow of the
/// pumps allow, by a forward and a backward pass over its poses (docs/methods.md#trajectory). The
/// stated rates keep the limits at every point, and so do differences of the points.
///
/// Between two phases the direction of the joints jumps. The corner is rounded within the
/// tolerance; the machine stops only where the joints turn by more than 120 degrees.
///
/// The points are the poses of the path but for these: poses that do not move are left out, a few
/// poses round a corner are replaced, and where none is left between two corners or ends there is a
/// point halfway. Coarse poses cost time: the squared speed is linear between points.
///
/// @throws Error (bad_input) if an option is out of range or the path has fewer than two poses
Trajectory time_dig_path(const Machine& machine, const DigPath& path,
                         const TrajectoryOptions& options = {});

/// CSV (docs/formats.md#trajectory): time, phase, joints, tip, floor angle, rates, and the
/// cylinders if the machine states them. Numbers do not obey the locale.
std::string to_csv(const Trajectory& trajectory);

/// The same as JSON, which load_trajectory() reads back exactly (docs/formats.md#trajectory).
std::string to_json(const Trajectory& trajectory);

/// @throws Error (bad_file) naming file, key, value and rule
Trajectory load_trajectory(const std::string& path);

}  // namespace excavplan
