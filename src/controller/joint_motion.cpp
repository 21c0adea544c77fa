// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/controller/joint_motion.hpp>

namespace excavplan {

JointNames opera_joint_names() {
  return {"swing_joint", "boom_joint", "arm_joint", "bucket_joint"};
}

JointMotion joint_motion(const DigPlan& plan, const JointNames& names) {
  JointMotion motion;
  for (const std::string& name : names) {
    if (!name.empty()) motion.names.push_back(name);
  }
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    const Eigen::Vector4d joints(0.0, point.joints[0], point.joints[1], point.joints[2]);
    const Eigen::Vector4d rates(0.0, point.rates[0], point.rates[1], point.rates[2]);
    JointPoint sent = {point.time, {}, {}};
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].empty()) continue;
      sent.positions.push_back(joints[static_cast<Eigen::Index>(i)]);
      sent.velocities.push_back(rates[static_cast<Eigen::Index>(i)]);
    }
    motion.points.push_back(std::move(sent));
  }
  return motion;
}

}  // namespace excavplan
