// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <excavplan/machine/body_and_drive.hpp>
#include <excavplan/machine/cylinders.hpp>
#include <excavplan/machine/robot_joint.hpp>

/// @file
/// The excavator in its boom plane: x forward from the swing axis, z up from the ground.
///
/// Joint angles (boom, arm, bucket) follow the machine's own convention: zero boom is level, zero
/// arm and bucket continue the link before, positive turns down and curls in. A direction in the
/// plane is (cos, sin) of its angle, counter-clockwise from +x:
///
///     boom pin -> arm pin     at  phi1 = -boom
///     arm pin  -> bucket pin  at  phi2 = -boom - arm
///     bucket pin -> tip       at  phi3 = -boom - arm - bucket
///
/// The floor angle of the bucket is 0 when its floor is level and positive when the heel is above
/// the tip; it is the clearance under the heel in a level drag. floor_angle = phi3 + pi - beta,
/// where beta is the angle between the floor and the line from tip to bucket pin.

namespace excavplan {

/// In the order of all arrays and vectors of joints.
enum class Joint { boom, arm, bucket };
/// "boom", "arm" or "bucket".
const char* name(Joint joint);

/// (boom, arm, bucket) [rad]; also torques [N m] and rates [rad/s] in the same order and sense.
using JointAngles = Eigen::Vector3d;

/// Mass of a link and its centre, from the pin of the link.
struct LinkMass {
  double mass = 0.0;    ///< [kg]
  double along = 0.0;   ///< the line to the next pin, or to the tip [m]
  double across = 0.0;  ///< that line, counter-clockwise [m]
};

/// What a joint can do.
struct JointLimits {
  double lower = 0.0;         ///< [rad]
  double upper = 0.0;         ///< [rad]
  double speed = 0.0;         ///< [rad/s], > 0
  double acceleration = 0.0;  ///< [rad/s^2], > 0
  double torque = 0.0;        ///< [N m], > 0
};

/// Teeth in front of the lip: equal wedges.
struct Teeth {
  int count = 0;           ///< over the whole width
  double width = 0.0;      ///< of one [m]
  double thickness = 0.0;  ///< at the root [m]
  double length = 0.0;     ///< from root to point [m]
  double angle = 0.0;      ///< between both faces of the wedge [rad]
};

/// The bucket: its side profile extruded over its width.
struct Bucket {
  /// Corners of the cavity, (along, across) of the line from bucket pin to tip, counter-clockwise
  /// [m]. The first is the tip, the second the heel (end of the floor), the last the top edge; the
  /// side from the last to the first is the open mouth. Convex.
  std::vector<Eigen::Vector2d> profile;
  double width_outside = 0.0;   ///< cuts this wide [m]
  double width_inside = 0.0;    ///< holds this wide [m]
  double edge_thickness = 0.0;  ///< of the lip [m]
  double edge_angle = 0.0;      ///< wedge angle of the lip, its smallest rake [rad]
  std::optional<Teeth> teeth;   ///< nothing: a plain lip
};

/// A machine read from a file; immutable after that.
struct Machine {
  std::string name;                                    ///< "zx120"
  Eigen::Vector2d boom_pin = Eigen::Vector2d::Zero();  ///< x, z [m]
  double boom_length = 0.0;                            ///< boom pin to arm pin [m]
  double arm_length = 0.0;                             ///< arm pin to bucket pin [m]
  double bucket_length = 0.0;                          ///< bucket pin to tooth tip [m]
  double track_front = 0.0;              ///< x of the foremost part of the undercarriage [m]
  std::array<JointLimits, 3> limits;     ///< of boom, arm, bucket
  std::array<LinkMass, 3> links;         ///< likewise
  Bucket bucket;                         ///< with its teeth
  std::optional<Cylinders> cylinders;    ///< nothing if the file does not state them
  std::optional<Hydraulics> hydraulics;  ///< likewise; never without cylinders
  std::optional<Body> body;              ///< nothing: the machine stands as if bolted down
  std::optional<Swing> swing;            ///< nothing if the file does not state it
  std::optional<Engine> engine;          ///< nothing: its power sets no limit
  RobotJoints robot_joints = {{{"boom"}, {"arm"}, {"bucket"}, {"swing"}}};  ///< of its controller
  std::optional<double> track_width;  ///< over both tracks [m]; nothing: undercarriage_width()
  /// On the site, not of the file; coordinates of a machine that does not stand level, and of all
  /// ground that it digs, are those of its own frame: z along the swing axis, 0 under the tracks.
  Attitude attitude = {};
  std::optional<double> tail_radius;  ///< from the swing axis [m]; nothing: tail_swing_radius()
  /// Takes points from the root frame of the robot's URDF to the site frame: a shift and a turn
  /// about z. Affects no dig.
  Eigen::Isometry3d site_from_root = Eigen::Isometry3d::Identity();

  /// Boom pin to tip with all links in one line, the longest reach [m].
  double full_length() const { return boom_length + arm_length + bucket_length; }
  /// From the swing axis to the corner of the bucket furthest from it [m]; rounded up.
  double swing_reach() const;
  /// track_width [m]; without it as the zx120's in proportion to track_front, ours.
  double undercarriage_width() const;
  /// Unit vector against gravity in the boom plane, as far as it lies in it: (0, 1) if level.
  /// @param swung  of the upper structure to the left [rad]
  Eigen::Vector2d up(double swung = 0.0) const;
  /// tail_radius [m]; without it 1.35 times track_front, ours, above the 1.18 of the zx120.
  double tail_swing_radius() const;
  /// Angle between bucket floor and the line from tip to bucket pin [rad]; Error without a profile.
  double beta() const;
};

/// The same machine, standing so.
Machine with_attitude(Machine machine, const Attitude& attitude);

/// Reads a machine file (docs/formats.md); every number in it names its source.
/// @throws Error (bad_file) naming file, key, value and rule; among the rules: lengths and masses
///         positive, limits in order, arm limits in 0 .. pi (the elbow stays above), profile
///         convex, counter-clockwise, tip at (bucket_length, 0), length of every cylinder strictly
///         rising or falling over the range of its joint
Machine load_machine(const std::string& path);

/// All that lays out, times or digs a path asks of a machine the rules of load_machine(), but that
/// a torque may be infinite and a link weigh 0. Functions of one posture (kinematics.hpp) do not
/// ask: what is not finite in their arguments is not finite in their result.
/// @throws Error (bad_input) naming machine, member, value and rule
void require_machine(const Machine& machine);

/// 16 hexadecimal digits that depend on every number of a machine that affects a dig, but not on
/// its name.
std::string fingerprint(const Machine& machine);

/// Capacity of the bucket with its mouth level, filled to the mouth [m^3].
/// @throws Error (bad_input) if the profile has fewer than three corners or no area
double struck_capacity(const Machine& machine);

/// The same with a heap on it that falls by `slope` [rad] to all four sides [m^3]. ISO 7451 rates
/// excavator buckets at 1:1, slope = pi / 4.
/// @throws Error (bad_input) likewise, or unless the slope is in 0 .. 1.5
double heaped_capacity(const Machine& machine, double slope = 0.7853981633974483);

}  // namespace excavplan
