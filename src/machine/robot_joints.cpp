// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"
#include "machine/machine_reading.hpp"

namespace excavplan {
namespace {

constexpr std::array<const char*, 4> words = {"boom", "arm", "bucket", "swing"};

RobotJoint read_robot_joint(JsonObject file, RobotJoint joint) {
  joint.name = file.text_or("name", joint.name);
  joint.sign = file.number_or("sign", joint.sign, -1.0, 1.0);
  if (std::abs(joint.sign) != 1.0)
    file.fail("sign", "is " + number_text(joint.sign) + ", must be -1 or 1");
  joint.zero = file.number_or("zero_rad", joint.zero, -10.0, 10.0);
  file.done();
  return joint;
}

}  // namespace

RobotJoints read_robot_joints(JsonObject file) {
  RobotJoints joints = Machine{}.robot_joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (file.has(words[i])) joints[i] = read_robot_joint(file.object(words[i]), joints[i]);
    for (std::size_t other = 0; other < i; ++other) {
      if (joints[i].name.empty() || joints[i].name != joints[other].name) continue;
      file.fail(words[i], "has the name " + in_quotes(joints[i].name) + " of " + words[other]);
    }
  }
  file.ignore("sources");
  file.done();
  return joints;
}

nlohmann::ordered_json robot_joints_json(const RobotJoints& joints) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    json[words[i]] = {
        {"name", joints[i].name}, {"sign", joints[i].sign}, {"zero_rad", joints[i].zero}};
  }
  return json;
}

}  // namespace excavplan
