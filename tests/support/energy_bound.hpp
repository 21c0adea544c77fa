// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include "simulation/bucket_cavity.hpp"

namespace excavplan::test {

/// What lifting the payload from the level of the ground at z = 0 takes, over the energy of the dig
/// and what the weight of the links gives: at most 1 (docs/methods.md#energy).
inline double share_of_lifting(const Machine& machine, const DigPath& path,
                               const DigResult& result) {
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
