// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace excavplan::test {

/// A joint of a URDF written here.
struct WrittenJoint {
  std::string name, type, parent, child;
  std::string xyz = "0 0 0", rpy = "0 0 0", axis = "0 1 0";
  std::string limit = {};  ///< attributes; empty: none
};

std::string joint_text(const WrittenJoint& joint);

std::string link_text(const std::string& name, const std::string& mass = {});

/// Joints of a machine with the names, lengths and ranges that are public of the ZX120.
std::array<WrittenJoint, 5> zx120_joints();

/// A URDF of these joints, with the masses of placeholders.
template <typename Joints>
std::string urdf_of(const Joints& joints, const std::string& more = {}) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<!-- written for a test -->\n<robot name=\"digger\">\n";
  text += link_text("base_link");
  for (const WrittenJoint& joint : joints) text += link_text(joint.child, "0.03");
  for (const WrittenJoint& joint : joints) text += joint_text(joint);
  return text + more + "</robot>\n";
}

}  // namespace excavplan::test
