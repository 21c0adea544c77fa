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

inline std::string joint_text(const WrittenJoint& joint) {
  return "  <joint name=\"" + joint.name + "\" type=\"" + joint.type + "\">\n    <parent link=\"" +
         joint.parent + "\"/>\n    <child link=\"" + joint.child + "\"/>\n    <origin xyz=\"" +
         joint.xyz + "\" rpy=\"" + joint.rpy + "\"/>\n    <axis xyz=\"" + joint.axis + "\"/>\n" +
         (joint.limit.empty() ? "" : "    <limit " + joint.limit + "/>\n") + "  </joint>\n";
}

inline std::string link_text(const std::string& name, const std::string& mass = {}) {
  if (mass.empty()) return "  <link name=\"" + name + "\"/>\n";
  return "  <link name=\"" + name + "\">\n    <inertial>\n      <origin xyz=\"0.3 0 0.1\"/>\n" +
         "      <mass value=\"" + mass +
         "\"/>\n      <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
         "iyy=\"1\" iyz=\"0\" izz=\"1\"/>\n    </inertial>\n  </link>\n";
}

/// Joints of a machine with the names, lengths and ranges that are public of the ZX120.
inline std::array<WrittenJoint, 5> zx120_joints() {
  return {
      {{"swing_joint", "continuous", "base_link", "body_link", "0 0 1.0", "0 0 0", "0 0 1"},
       {"boom_joint", "revolute", "body_link", "boom_link", "0.14 -0.164 0.424", "0 0 0", "0 1 0",
        "lower=\"-1.2217\" upper=\"0.7679\" effort=\"500\" velocity=\"6.16\""},
       {"arm_joint", "revolute", "boom_link", "arm_link", "4.6 0 0", "0 0 0", "0 1 0",
        "lower=\"0.5236\" upper=\"2.6529\" effort=\"500\" velocity=\"0.5\""},
       {"bucket_joint", "revolute", "arm_link", "bucket_link", "2.519 0 0", "0 0 0", "0 1 0",
        "lower=\"-0.576\" upper=\"2.4958\" effort=\"1\" velocity=\"0.5\""},
       {"bucket_end_joint", "fixed", "bucket_link", "bucket_end_link", "1.23 0 0", "0 0.8727 0"}}};
}

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
