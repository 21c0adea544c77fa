// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <excavplan/machine/kinematics.hpp>

#include "machine/plane.hpp"

/// @file Masses of the front about the swing axis. Private to the project.

namespace excavplan {

/// Centre of the bucket's cavity in the bucket frame, where the payload is taken to be.
inline Eigen::Vector2d cavity_centre(const Bucket& bucket) {
  const std::vector<Eigen::Vector2d>& corners = bucket.profile;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
    const double twice = cross(corners[i], next);
    sum += twice / 3.0 * (corners[i] + next);
    area += twice;
  }
  return sum / area;
}

/// Distances of the links' centres of mass from the swing axis, along x [m].
inline Eigen::Vector3d link_centres(const Machine& machine, const LinkPositions& at) {
  const double pins[] = {machine.boom_pin.x(), at.arm_pin.x(), at.bucket_pin.x()};
  const double angles[] = {at.phi1, at.phi2, at.phi3};
  Eigen::Vector3d centres;
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const LinkMass& link = machine.links[i];
    centres[static_cast<Eigen::Index>(i)] =
        pins[i] + link.along * std::cos(angles[i]) - link.across * std::sin(angles[i]);
  }
  return centres;
}

/// About the swing axis, with the upper structure: links and payload as points [kg m^2].
/// @param centre  cavity_centre() of its bucket
inline double swing_inertia(const Machine& machine, const Eigen::Vector2d& centre,
                            const JointAngles& joints, double payload) {
  const LinkPositions at = link_positions(machine, joints);
  const Eigen::Vector3d centres = link_centres(machine, at);
  double sum = machine.swing->inertia + payload * std::pow(bucket_point(at, centre).x(), 2);
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    sum += machine.links[i].mass * std::pow(centres[static_cast<Eigen::Index>(i)], 2);
  }
  return sum;
}

}  // namespace excavplan
