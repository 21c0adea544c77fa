// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include <excavplan/machine/machine.hpp>

#include "machine/urdf_tree.hpp"

/// @file Boom, arm and bucket of a URDF in the plane of the boom. Private to the project.

namespace excavplan {

/// What is what in a URDF; by default the names of OPERA's machines.
struct UrdfNames {
  std::optional<std::string> swing = "swing_joint";  ///< nothing: the root turns by no joint
  std::array<std::string, 3> joints = {"boom_joint", "arm_joint", "bucket_joint"};
  std::string tip = "bucket_end_joint";  ///< a joint, whose child is the tip, or a link
  double ground = 0.0;                   ///< z of the ground in the frame of the root [m]
};

/// A joint and the links that it moves but the next does not, in the conventions of a Machine.
struct UrdfPart {
  RobotJoint angle;
  UrdfLimits limits;    ///< its range in the angles of a Machine
  double length = 0.0;  ///< to the next pin or the tip [m]
  LinkMass mass;        ///< mass 0: the URDF states none
};

struct UrdfFront {
  Eigen::Vector2d boom_pin;       ///< x from the swing axis, z above the ground [m]
  std::array<UrdfPart, 3> parts;  ///< boom, arm, bucket
  UrdfLimits swing;               ///< its range as of a Machine; none: it turns round and round
  RobotJoint swing_angle;
  double swing_x = 0.0, swing_y = 0.0;  ///< of the swing axis in the frame of the root [m]
  double ahead = 0.0;  ///< direction of the boom from x in the frame of the root [rad]
};

/// @throws Error (bad_file) if a joint is missing or of a wrong kind, the order differs, or the
/// axes
///         are not parallel, level and across an upright swing axis within 1e-3 rad
UrdfFront front_of(const UrdfTree& tree, const UrdfNames& names);

}  // namespace excavplan
