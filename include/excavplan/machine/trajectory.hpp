// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>
#include <excavplan/machine/dig_path.hpp>

namespace excavplan {

/// Of the upper structure, about z, positive to the left; 0 where the boom plane is y = 0, and so
/// is every whole turn of a machine that turns round and round.
struct SwingState {
  double angle = 0.0;         ///< [rad]
  double rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;  ///< [rad/s^2]
};

/// The machine at one time.
struct TrajectoryPoint {
  double time = 0.0;                         ///< [s], starts at 0, strictly increasing
  DigPhase phase = DigPhase::penetrate;      ///< that leads here
  JointAngles joints = JointAngles::Zero();  ///< [rad]
  JointAngles rates = JointAngles::Zero();   ///< [rad/s]
  BucketPose bucket;                         ///< of these joint angles
  /// Lengths of the cylinders of boom, arm and bucket, pin to pin [m]; NaN if the machine does not
  /// state its cylinders.
  Eigen::Vector3d cylinders = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d cylinder_speeds = cylinders;  ///< [m/s]; NaN likewise
  /// [rad/s^2]; NaN in a trajectory of time_dig_path(), which jump at its points.
  JointAngles accelerations = JointAngles::Constant(std::numeric_limits<double>::quiet_NaN());
  SwingState swing;  ///< at rest at 0 in a trajectory of time_dig_path()
};

/// Which plan a motion is of, where its machine stands, and for how long it holds.
struct PlanStamp {
  std::string id;  ///< 16 hexadecimal digits that depend on machine, ground, dig and motion
  /// Puts the frame of the machine (origin on the swing axis at ground level) into that of the scan
  /// that the plan was made on: a rigid motion.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  /// By the clock of the messages [ns]: when the scan was measured and until when people and
  /// machines in it are taken to be where it shows them; nothing: the scan does not tell.
  std::optional<std::int64_t> scanned = {};
  std::optional<std::int64_t> expires = {};  ///< likewise
};

/// A dig path or a way (motion.hpp) with its times.
struct Trajectory {
  std::string machine;                  ///< its name
  std::vector<TrajectoryPoint> points;  ///< in the order of time
  /// Machine::robot_joints; time_way() leaves the name of one that is not there empty.
  RobotJoints robot_joints = Machine{}.robot_joints;
  /// Of plan_motion(): Way::warnings, motion_overload, motion_tips. Not in files.
  std::vector<Warning> warnings = {};
  std::optional<PlanStamp> plan = {};  ///< nothing: it is not known of which plan it is
  /// Of all points [s].
  double duration() const { return points.empty() ? 0.0 : points.back().time; }
  double dig_duration() const;  ///< of penetrate, drag and scoop [s]
};

/// Settings of time_dig_path().
struct TrajectoryOptions {
  /// Fraction of the limits of joint speed, joint acceleration, cylinder speed, pump flow and power
  /// to use, in (0, 1].
  double speed_fraction = 0.8;
  /// Largest distance of the tip from the path where it rounds the corner between two phases [m],
  /// in 0 .. 0.01; the attitude of the bucket deviates by at most as much over the length of the
  /// bucket. 0: the machine stops there.
  double corner_tolerance = 0.001;
};

/// Times a path as fast as joint speeds, joint accelerations, cylinder speeds and the flow and
/// power of the pumps allow, by a forward and a backward pass over its poses
/// (`docs/methods.md#trajectory`). The stated rates keep the limits at every point, and so do
/// differences of the points.
///
/// Between two phases the direction of the joint motion changes. The corner is rounded within the
/// tolerance; the machine stops only where the direction changes by more than 120 degrees.
///
/// The points are the poses of the path, except that poses without motion are left out, a few poses
/// at a corner are replaced, and a point halfway is added where none is left between two corners or
/// ends. Coarse poses make a slower trajectory: the squared speed is linear between points.
///
/// @param torques  DigResult::torques: of the joints from each pose of the path to the next [N m].
///                 Where they end, and on the approach, nothing loads the pumps.
/// @throws Error (bad_input) as require_machine(); if an option is out of range, the path has fewer
///         than two poses or a joint that is not finite, or there are as many torques as poses, or
///         one that is not finite
Trajectory time_dig_path(const Machine& machine, const DigPath& path,
                         const TrajectoryOptions& options = {},
                         const std::vector<JointAngles>& torques = {});

/// CSV (`docs/formats.md#trajectory`): time, phase, joints, tip, floor angle, rates, the cylinders
/// if the machine states them, and of time_way() accelerations and swing. Numbers do not depend on
/// the locale.
std::string to_csv(const Trajectory& trajectory);

/// The same as JSON, which load_trajectory() reads back exactly (`docs/formats.md#trajectory`).
/// @throws Error (bad_input) naming a number that is not finite or a text that is not UTF-8
std::string to_json(const Trajectory& trajectory);

/// Reads what to_json() writes. @throws Error (bad_file) naming file, key, value and rule
Trajectory load_trajectory(const std::string& path);

}  // namespace excavplan
