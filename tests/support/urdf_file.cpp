// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/urdf_file.hpp"

#include <array>
#include <string>

namespace excavplan::test {

std::string joint_text(const WrittenJoint& joint) {
  return "  <joint name=\"" + joint.name + "\" type=\"" + joint.type + "\">\n    <parent link=\"" +
         joint.parent + "\"/>\n    <child link=\"" + joint.child + "\"/>\n    <origin xyz=\"" +
         joint.xyz + "\" rpy=\"" + joint.rpy + "\"/>\n    <axis xyz=\"" + joint.axis + "\"/>\n" +
         (joint.limit.empty() ? "" : "    <limit " + joint.limit + "/>\n") + "  </joint>\n";
}

std::string link_text(const std::string& name, const std::string& mass) {
  if (mass.empty()) return "  <link name=\"" + name + "\"/>\n";
  return "  <link name=\"" + name + "\">\n    <inertial>\n      <origin xyz=\"0.3 0 0.1\"/>\n" +
         "      <mass value=\"" + mass +
         "\"/>\n      <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
         "iyy=\"1\" iyz=\"0\" izz=\"1\"/>\n    </inertial>\n  </link>\n";
}

std::array<WrittenJoint, 5> zx120_joints() {
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

}  // namespace excavplan::test
