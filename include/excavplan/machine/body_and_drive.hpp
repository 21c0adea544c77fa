// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

/// @file
/// Parts of a Machine: what it stands on, what turns it and what drives it.

namespace excavplan {

/// How a machine stands: turns of right-handed sense from the level site frame (x forward, y left,
/// z up), first about y, then about the x so turned.
struct Attitude {
  double roll = 0.0;   ///< positive: its left side is up [rad]
  double pitch = 0.0;  ///< positive: its front is down [rad]

  /// Neither turn is there.
  bool is_level() const { return roll == 0.0 && pitch == 0.0; }
  /// Takes vectors of the frame of the machine into the level site frame.
  Eigen::Matrix3d to_site() const;
  /// Unit vector against gravity in the frame of the machine.
  Eigen::Vector3d up() const;
};

/// What stands on the ground: the machine without boom, arm and bucket.
struct Body {
  double mass = 0.0;                                 ///< [kg]
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of its mass: x, z [m]
  double rear_edge = 0.0;       ///< x about which it tips backwards, below its centre's [m]
  double front_edge = 0.0;      ///< x about which it tips forwards, above its centre's [m]
  double track_friction = 0.0;  ///< largest force along the ground over weight on it [-]
};

/// What turns the upper structure.
struct Swing {
  double speed = 0.0;    ///< highest rate [rad/s]
  double torque = 0.0;   ///< [N m]
  double inertia = 0.0;  ///< of the upper structure without its front, about the axis [kg m^2]
  /// Range, to the left of the plane of the dig; infinite: it turns round and round [rad].
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  ///< likewise [rad]
  /// Highest acceleration, where the torque would allow more [rad/s^2].
  double acceleration = std::numeric_limits<double>::infinity();

  /// Whether whole turns make no difference.
  bool turns_round() const { return lower == -std::numeric_limits<double>::infinity(); }
};

/// What drives the cylinders.
struct Engine {
  double power = 0.0;       ///< that the pumps can deliver to the cylinders [W]
  double idle_power = 0.0;  ///< of the shaft, drawn all the time, working or not [W]
};

}  // namespace excavplan
