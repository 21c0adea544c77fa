// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "machine/urdf_tree.hpp"

/// @file The joints of an excavator among those of a URDF. Private to the project.

namespace excavplan {

/// What the parts of a front are called in the JSON beside a URDF.
inline constexpr std::array<const char*, 3> front_words = {"boom", "arm", "bucket"};

/// What is what in a URDF, and what the JSON beside it says instead; by default the names of
/// OPERA's machines.
struct UrdfNames {
  std::string beside;                                ///< the JSON, there or not, for messages
  std::optional<std::string> swing = "swing_joint";  ///< nothing: the root turns by no joint
  bool swing_stated = false;
  std::array<std::string, 3> joints = {"boom_joint", "arm_joint", "bucket_joint"};
  std::string tip = "bucket_end_joint";  ///< a joint, whose child is the tip, or a link
  /// The tip in the frame of the link that the bucket's joint moves [m]; wins over `tip`.
  std::optional<Eigen::Vector3d> tip_at;
  double ground = 0.0;  ///< z of the ground in the frame of the root [m]
  /// In the frame of the root: of the two sides of the boom's plane the one nearer to it is ahead.
  std::optional<Eigen::Vector3d> forward;
  std::array<UrdfLimits, 3> ranges;  ///< those stated, in the angles of a Machine
};

/// A joint at the zero of all joints, in the frame of the root.
struct PlacedJoint {
  const UrdfJoint* joint = nullptr;
  Eigen::Vector3d pin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
};

struct UrdfChain {
  PlacedJoint swing;  ///< no joint: the root turns by none
  std::array<PlacedJoint, 3> parts;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< level, in the boom's plane
  /// Of the URDF's angles, where it is one: not of a `continuous` joint, not empty, no whole turn,
  /// and not ±pi/2 on all three alike, which exporters write where nothing is known.
  std::array<bool, 3> has_range = {};
};

/// Which way is ahead is seen in the posture of all joints at zero, or nearest to that in their
/// ranges: boom ahead; where it stands upright the elbow above the line from boom pin to bucket
/// pin, as of every excavator; else the boom pin ahead of the swing axis, the bucket curled in.
/// @throws Error (bad_file) naming at once all that neither the URDF nor the JSON says; if a joint
///         is of a wrong kind, the order differs, or the axes are not parallel, level and across an
///         upright swing axis within 1e-3 rad
UrdfChain chain_of(const UrdfTree& tree, const UrdfNames& names);

}  // namespace excavplan
