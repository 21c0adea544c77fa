// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include <excavplan/machine/dig_parameters.hpp>
#include <excavplan/machine/kinematics.hpp>

/// @file
/// Poses and joint angles of one dig, from its parameters.
///
///     DigParameters -> DigPath -> Trajectory (trajectory.hpp)
///
/// Path rules: the paper, section 2.3.2; geometry: docs/methods.md#path.

namespace excavplan {

/// The parts of a working cycle, in their order; those of a dig end with the lift.
enum class DigPhase { approach, penetrate, drag, scoop, lift, swing, dump, back };
/// "penetrate", as in files and messages.
const char* name(DigPhase phase);

/// The bucket at one point of the path and the joints that hold it there.
struct DigPose {
  DigPhase phase = DigPhase::penetrate;      ///< that the pose is part of
  BucketPose bucket;                         ///< place and attitude of the bucket
  JointAngles joints = JointAngles::Zero();  ///< boom, arm and bucket [rad]
};

/// A dig that the machine can drive. Poses are in the order in which they are visited; the last
/// pose of a phase is the first of the next and is stored once, with the earlier phase.
struct DigPath {
  DigParameters parameters;  ///< that it was made from
  double start_x = 0.0;      ///< where the tip meets the ground [m]
  double ground_z = 0.0;     ///< height of the ground there [m]
  /// The way down to the first pose, which is not repeated; empty unless set (way_down()).
  std::vector<DigPose> approach;
  std::vector<DigPose> poses;   ///< penetrate, drag, scoop, lift; at least two
  double heel_clearance = 0.0;  ///< smallest floor angle during the drag [rad]
  LimitMargin limit_margin;     ///< smallest over all poses
  double overcut = 0.0;         ///< how far the scoop goes below the drag line [m], >= 0
  double drag_grade = 0.0;      ///< DigPathOptions::drag_grade
  bool meets_floor = false;     ///< DigPathOptions::floor made it shallower
};

/// Why a dig cannot be driven: the first thing that fails.
struct Infeasible {
  /// Which rule it breaks.
  enum class Reason {
    bad_parameter,  ///< not finite or negative, or the angle is not in (0, pi/2)
    out_of_reach,   ///< too far or too near
    joint_limit,
    heel_contact,  ///< the floor presses on the ground behind the cut
    too_deep,      ///< below DigPathOptions::max_depth
    too_near_tracks,
    unknown_ground,  ///< at the start point, whose x is `value`
    lift_blocked,    ///< the bucket cannot be lifted clear of the ground
    front_contact,   ///< boom or arm would pass through the ground; not told from a profile
  };
  Reason reason = Reason::bad_parameter;  ///< which rule it breaks
  DigPhase phase = DigPhase::penetrate;   ///< in which it breaks it
  Joint joint = Joint::boom;              ///< for joint_limit
  double distance = 0.0;                  ///< travelled in that phase: [m], [rad] while scooping
  double value = 0.0;                     ///< what was found
  double limit = 0.0;                     ///< what was allowed, in the unit of value
  std::string message;                    ///< all of this in one sentence
};

/// Height of the ground in the boom plane at x [m]; NaN where unknown.
using GroundProfile = std::function<double(double x)>;

/// Rules of a path.
struct DigPathOptions {
  /// Largest tip travel between poses [m], > 0; at most 10000 poses a phase.
  double step = 0.025;
  /// Of the floor above the cut in the drag [rad]; 2 deg, ours, for a machine that does not track
  /// exactly. The penetration has exactly 0 by definition.
  double min_heel_clearance = 0.035;
  /// Below the ground at the start point [m], > 0; ours.
  double max_depth = 2.0;
  /// The tip stays this far ahead of the tracks [m]; ours.
  double track_margin = 0.5;
  /// The lowest point of the bucket ends this far above the ground [m]; ours.
  double lift_clearance = 0.3;
  /// Surface below which no part of the bucket cuts, over its whole width [m]; NaN: none there;
  /// empty: none. The path becomes shallower: the penetration ends on it, the drag follows it where
  /// the line of the drag is deeper, the scoop rises.
  GroundProfile floor = {};
  /// Of the line of the drag, positive if it rises away from the machine, within 1 rad [rad]; 0 in
  /// the paper.
  double drag_grade = 0.0;
  /// The bucket keeps its attitude in the drag, for a finishing pass; in the paper it keeps its
  /// angle to the arm.
  bool drag_keeps_angle = false;
  /// In the drag the tip follows the floor, and the bucket keeps its angle to it as it falls or
  /// rises over 0.5 m (ours): down a slope, along its foot, and curled up another one.
  bool drag_follows_floor = false;
  /// Of the bucket's floor over the line of penetration, so that a machine that does not track
  /// exactly does not press its heel into the ground, in 0 .. 1 rad [rad]; 0 in the paper.
  double penetration_clearance = 0.0;
};

/// Options for a path that was planned on another measurement of the same ground. Planned paths
/// are often at the limit of the distances above, and the other ground may lie some millimetres
/// off: the limits are relaxed by 0.01 rad and 0.02 m; ours.
DigPathOptions rules_for_planned_path();
/// Likewise the machine of such a path: boom, arm and bucket may go 0.01 rad beyond their limits.
Machine machine_for_planned_path(Machine machine);

/// Lays out penetration, drag, scoop and lift, and solves the joints of every pose in closed form.
///
/// Penetrate: the floor is parallel to the line of penetration. Drag: the tip moves level, the
/// angle between arm and bucket stays. Scoop: only the bucket turns, until the line from bucket pin
/// to tip is level, which levels the mouth within a few degrees. Lift (not in the paper): the boom
/// rises, the bucket keeps its attitude, until it is clear of the highest known ground under it; a
/// bucket that comes to its limit out of the ground opens from there on. A phase of length 0 is
/// left out. Checks are made at the poses.
///
/// @throws Error (bad_input) if an option is out of range; bad parameters are returned as
/// Infeasible
std::variant<DigPath, Infeasible> make_dig_path(const Machine& machine,
                                                const DigParameters& parameters, double start_x,
                                                const GroundProfile& ground,
                                                const DigPathOptions& options = {});

/// Chooses the start point from a scan of the reach: the one whose smallest margin to the joint
/// limits and to heel contact is largest, the middle one of several (docs/methods.md#path).
///
/// @return the path from there, or why the best of the failing start points fails: the one that
/// gets furthest, at a few poses a phase unless these miss what stops it
std::variant<DigPath, Infeasible> make_dig_path_anywhere(const Machine& machine,
                                                         const DigParameters& parameters,
                                                         const GroundProfile& ground,
                                                         const DigPathOptions& options = {});

/// The way down to the first pose of a path, for DigPath::approach: with the bucket's attitude that
/// of the first pose, the boom lowers it from where it is clear of the ground by lift_clearance. It
/// is the lift backwards, with the same rules.
///
/// @return the poses, the highest first and without the first pose of the path, or what blocks them
/// @throws Error (bad_input) if an option is out of range or the path has no pose
std::variant<std::vector<DigPose>, Infeasible> way_down(const Machine& machine, const DigPath& path,
                                                        const GroundProfile& ground,
                                                        const DigPathOptions& options = {});

}  // namespace excavplan
