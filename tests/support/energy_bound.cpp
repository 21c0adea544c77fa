// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/energy_bound.hpp"

#include <algorithm>

#include <excavplan/soil/soil.hpp>

namespace excavplan::test {

double share_of_lifting(const Machine& machine, const DigPath& path, const DigResult& result) {
  double released = 0.0;
  DigPose last = path.poses.front();
  for (const DigPose& pose : path.poses) {
    if (pose.phase == DigPhase::lift) break;
    const JointAngles middle = 0.5 * (last.joints + pose.joints);
    released -= torque_against_link_weight(machine, link_positions(machine, middle))
                    .dot(pose.joints - last.joints);
    last = pose;
  }
  Cavity cavity(machine.bucket);
  cavity.turn_to(link_positions(machine, last.joints).phi3);
  const double rise = last.bucket.z + cavity.packed(result.payload_volume).centroid.y();
  return result.payload_mass * gravity * rise / (result.energy.total + std::max(0.0, released));
}

}  // namespace excavplan::test
