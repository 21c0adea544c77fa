// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>

#include "base/angles.hpp"

namespace excavplan {

inline constexpr double cone_half_angle = 15.0 * degree;  ///< of the standard cone (ASAE S313)
/// Of its width, at which a footing has its full capacity; ours.
inline constexpr double bearing_settlement = 0.1;

/// One stretch of the path: the tip goes from `from` to `to` while the joints turn by `turn`.
struct Stretch {
  DigPhase phase = DigPhase::penetrate;
  std::size_t pose = 0;  ///< where it begins, in the path
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  JointAngles joints;  ///< half-way
  JointAngles turn;
  LinkPositions at;  ///< half-way
  double length = 0.0;

  Eigen::Vector2d direction() const { return (to - from) / length; }
};

/// What the soil does to the bucket: a force in the face, one at the lip, one under the heel [N].
struct Resistance {
  Eigen::Vector2d face_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d face_point = Eigen::Vector2d::Zero();
  Eigen::Vector2d lip_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d heel_force = Eigen::Vector2d::Zero();
  Eigen::Vector2d heel_point = Eigen::Vector2d::Zero();
  double borne_weight = 0.0;  ///< of the soil that the wedge carries; the bucket carries the rest
  double wedge_length = 0.0;  ///< of the top of the wedge that is pushed, ahead of the lip [m]
  double edge = 0.0;          ///< part of lip_force that is of lip and teeth, against the motion

  /// Where the heel stands on loose soil that can be compacted.
  struct Pressed {
    Eigen::Index col;
    double pressure;  ///< [Pa]
  };
  std::vector<Pressed> pressed;

  Eigen::Vector2d total() const { return face_force + lip_force + heel_force; }
};

}  // namespace excavplan
