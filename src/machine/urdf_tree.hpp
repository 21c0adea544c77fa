// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

/// @file The links and joints of a URDF. Private to the project.

namespace excavplan {

/// What a joint of a URDF may do, as far as the file says it.
struct UrdfLimits {
  std::optional<double> lower, upper;  ///< [rad]
  std::optional<double> velocity;      ///< [rad/s]
  std::optional<double> effort;        ///< [N m]
};

struct UrdfJoint {
  std::string name, type;
  std::size_t line = 0;  ///< of the file
  std::string parent, child;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< in the frame of the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< of length 1, in the joint's frame
  UrdfLimits limits;
  bool mimics = false;  ///< follows another joint
};

struct UrdfLink {
  std::string name;
  std::optional<double> mass;                        ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the mass, in the link's frame [m]
};

/// A tree: every link but one is the child of one joint, and all hang on that one.
struct UrdfTree {
  std::string file;
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;

  const UrdfJoint* joint(const std::string& name) const;  ///< null: none
  const UrdfLink* link(const std::string& name) const;    ///< null: none
  /// The joints from the root to a link.
  std::vector<const UrdfJoint*> chain_to(const std::string& link) const;
  /// @throws Error (bad_file) "FILE: line LINE: joint 'NAME' WHAT"
  [[noreturn]] void refuse(const UrdfJoint& of, const std::string& what) const;
};

/// Reads links and joints; what else the file has, such as meshes, is skipped. Numbers must be
/// finite and at most 1e6.
/// @throws Error (bad_file) naming file, line, value and rule; with the command that expands it if
/// it is a xacro
UrdfTree parse_urdf(const std::string& path, const std::string& content);

}  // namespace excavplan
