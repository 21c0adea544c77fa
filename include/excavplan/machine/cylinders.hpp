// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <variant>

#include <Eigen/Core>

/// @file
/// The hydraulic cylinders behind the joints: how long they are, how hard they push, how much oil
/// they take.
///
/// Every pin is polar about the pin of its joint, so a linkage does not depend on how long the
/// links are. Joint angles are those of the machine: positive turns down and curls in.

namespace excavplan {

/// A pin beside the pin of a joint, counter-clockwise of the direction of the link it sits on.
struct PolarPin {
  double distance = 0.0;  ///< from the joint's pin [m]
  double angle = 0.0;     ///< [rad]
};

/// A bar between a pin on one of the two links and the end of the cylinder's rod.
struct Bar {
  PolarPin pin;
  double length = 0.0;  ///< [m]
};

/// What stands between rod and bucket: the rod pushes the pin where both bars meet.
struct FourBar {
  Bar rocker;  ///< pinned to the link before the joint
  Bar link;    ///< pinned to the link after it
};

struct CylinderGeometry {
  int count = 1;  ///< cylinders side by side that share the work
  PolarPin foot;  ///< on the link before the joint; before the boom: from +x
  /// Where the rod acts: a pin on the link after the joint, or a four-bar.
  std::variant<PolarPin, FourBar> rod;
};

struct CylinderState {
  double length = 0.0;  ///< pin to pin [m]
  double lever = 0.0;   ///< d length / d joint angle [m/rad]; negative: pushing turns back
};

/// The cylinder of one joint (or the pair, all of it per cylinder). Its length grows or falls all
/// the way through the joint's range: this is proved when it is made.
class Cylinder {
 public:
  /// A four-bar is assembled uncrossed: in the middle of the range, the rod is on the far side of
  /// the line between the pins of rocker and link, seen from the joint.
  ///
  /// @param lower, upper  range of the joint [rad]
  /// @throws Error (bad_input) saying at which joint angle the parts do not meet or are at their
  ///         dead point, or that the stroke exceeds the shortest length, which no cylinder can
  Cylinder(const CylinderGeometry& geometry, double lower, double upper);

  /// Also beyond the range, as far as the parts meet; NaN where they do not.
  CylinderState at(double joint) const;

  /// Closed form; nothing where the length is not within the stroke (beyond rounding, 1e-12 m).
  std::optional<double> joint_angle(double length) const;

  /// Of each cylinder, for a torque of its joint [N m]; positive pushes [N].
  double force(double joint, double torque) const;

  int count() const { return geometry_.count; }
  double shortest() const { return shortest_; }           ///< [m]
  double longest() const { return longest_; }             ///< [m]
  double stroke() const { return longest_ - shortest_; }  ///< over the joint's range [m]

 private:
  struct RodEnd {
    Eigen::Vector2d position;
    Eigen::Vector2d velocity;  ///< per radian of the joint
  };
  RodEnd rod_end(double joint) const;
  void choose_assembly();
  void prove_one_to_one() const;
  double solve(double length) const;

  CylinderGeometry geometry_;
  Eigen::Vector2d foot_;
  Eigen::Vector2d rocker_pin_;  // of a four-bar; else of the joint
  double lower_, upper_;
  double shortest_ = 0.0, longest_ = 0.0;
  // Which of two assemblies: +1 if, going from one pin to the next, the third is on the left.
  double loop_side_ = 1.0;  // rocker pin, link pin: rod
  double rod_side_ = 1.0;   // pin it turns about, foot: rod
  double link_side_ = 1.0;  // joint, rod: link pin
};

/// Boom, arm, bucket.
using Cylinders = std::array<Cylinder, 3>;

std::array<CylinderState, 3> cylinder_states(const Cylinders& cylinders,
                                             const Eigen::Vector3d& joints);

/// What each cylinder of a joint must push (negative: pull) for the joints to give `torque` [N].
/// The weight of cylinders, rocker and link, and friction in the pins, are left out.
Eigen::Vector3d cylinder_forces(const Cylinders& cylinders, const Eigen::Vector3d& joints,
                                const Eigen::Vector3d& torque);

/// The inside of one cylinder.
struct Piston {
  double diameter = 0.0;                                   ///< [m]
  double rod_diameter = 0.0;                               ///< [m], below diameter
  double speed = std::numeric_limits<double>::infinity();  ///< it may have, either way [m/s]

  double area_filled(double growth) const;  ///< [m^2], of the side that takes oil as it grows
};

/// What drives boom, arm and bucket. The pumps must deliver count * area filled * speed, summed
/// over the joints: oil is not led from one side of a piston to the other (regeneration).
struct Hydraulics {
  std::array<Piston, 3> pistons;
  double pump_flow = 0.0;  ///< of all pumps together [m^3/s]
};

}  // namespace excavplan
