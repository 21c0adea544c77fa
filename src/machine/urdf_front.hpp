// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <excavplan/machine/machine.hpp>

#include "machine/urdf_chain.hpp"

/// @file Boom, arm and bucket of a URDF in the plane of the boom. Private to the project.

namespace excavplan {

/// A joint and the links that it moves but the next does not, in the conventions of a Machine.
struct UrdfPart {
  RobotJoint angle;
  UrdfLimits limits;    ///< its range in the angles of a Machine, where the URDF has one
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

/// @throws Error (bad_file) as chain_of(), or if two pins are nearer than 0.05 m
UrdfFront front_of(const UrdfTree& tree, const UrdfNames& names);

}  // namespace excavplan
