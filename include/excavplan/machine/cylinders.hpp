// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <variant>

#include <Eigen/Core>

/// @file
/// The hydraulic cylinders of the joints: their length, force and flow of oil.
///
/// Pins are given in polar coordinates about the pin of the joint, so that a linkage does not
/// depend on the lengths of the links. Joint angles are those of the machine: positive turns down
/// and curls in.

namespace excavplan {

/// A pin on a link, from the pin of the joint.
struct PolarPin {
  double distance = 0.0;  ///< from the pin of the joint [m]
  double angle = 0.0;     ///< from the direction of the link, counter-clockwise [rad]
};

/// A bar between a pin on one of the two links and the end of the cylinder's rod.
struct Bar {
  PolarPin pin;         ///< its end on the link
  double length = 0.0;  ///< [m]
};

/// The linkage between rod and bucket: the rod acts on the pin where both bars meet.
struct FourBar {
  Bar rocker;  ///< pinned to the link before the joint
  Bar link;    ///< pinned to the link after it
};

/// Where the cylinders of one joint are fixed.
struct CylinderGeometry {
  int count = 1;  ///< parallel cylinders that share the load
  PolarPin foot;  ///< on the link before the joint; before the boom: from +x
  /// Where the rod acts: a pin on the link after the joint, or a four-bar.
  std::variant<PolarPin, FourBar> rod;
};

/// A cylinder at one joint angle.
struct CylinderState {
  double length = 0.0;  ///< pin to pin [m]
  double lever = 0.0;   ///< d length / d joint angle [m/rad]; negative: pushing turns back
};

/// The cylinder of one joint, or one of a pair. Its length strictly rises or falls over the range
/// of the joint, which the constructor checks.
class Cylinder {
 public:
  /// A four-bar is assembled uncrossed: in the middle of the range, the end of the rod and the
  /// joint lie on different sides of the line between the pins of rocker and link.
  ///
  /// @param geometry where it is fixed
  /// @param lower end of the joint's range [rad]
  /// @param upper end of the joint's range [rad]
  /// @throws Error (bad_input) naming the joint angle at which the parts do not meet or are at
  /// their
  ///         dead point; also if the stroke exceeds the shortest length, which no cylinder can have
  Cylinder(const CylinderGeometry& geometry, double lower, double upper);

  /// State at a joint angle, also outside the range; NaN where the parts do not meet.
  CylinderState at(double joint) const;

  /// Joint angle of a length, in closed form; nothing outside the stroke (by more than 1e-12 m).
  std::optional<double> joint_angle(double length) const;

  /// Force of each cylinder for a torque of the joint [N m]; positive pushes [N].
  double force(double joint, double torque) const;

  const CylinderGeometry& geometry() const { return geometry_; }  ///< where it is fixed
  int count() const { return geometry_.count; }                   ///< parallel cylinders
  double shortest() const { return shortest_; }                   ///< [m]
  double longest() const { return longest_; }                     ///< [m]
  double stroke() const { return longest_ - shortest_; }          ///< over the joint's range [m]

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

/// States of all cylinders at these joint angles.
std::array<CylinderState, 3> cylinder_states(const Cylinders& cylinders,
                                             const Eigen::Vector3d& joints);

/// Force of each cylinder of a joint for `torque` of the joints; positive pushes [N]. The weight of
/// cylinders, rocker and link and the friction in the pins are neglected.
Eigen::Vector3d cylinder_forces(const Cylinders& cylinders, const Eigen::Vector3d& joints,
                                const Eigen::Vector3d& torque);

/// The inside of one cylinder.
struct Piston {
  double diameter = 0.0;                                   ///< [m]
  double rod_diameter = 0.0;                               ///< [m], below diameter
  double speed = std::numeric_limits<double>::infinity();  ///< highest, in both directions [m/s]

  /// Area of the side that takes oil while the length changes by `growth` (its sign counts) [m^2].
  double area_filled(double growth) const;
};

/// The hydraulics of boom, arm and bucket. The pumps deliver count * area filled * speed, summed
/// over the joints; there is no regeneration from one side of a piston to the other.
struct Hydraulics {
  std::array<Piston, 3> pistons;  ///< of boom, arm, bucket
  double pump_flow = 0.0;         ///< of all pumps together [m^3/s]
};

}  // namespace excavplan
