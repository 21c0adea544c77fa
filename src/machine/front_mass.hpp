// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

/// Centres of mass of the links, x and z [m].
inline std::array<Eigen::Vector2d, 3> link_centres(const Machine& machine,
                                                   const LinkPositions& at) {
  const std::array<Eigen::Vector2d, 3> pins = {machine.boom_pin, at.arm_pin, at.bucket_pin};
  const std::array<double, 3> angles = {at.phi1, at.phi2, at.phi3};
  std::array<Eigen::Vector2d, 3> centres;
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const LinkMass& link = machine.links[i];
    const Eigen::Vector2d along = direction(angles[i]);
    centres[i] =
        pins[i] + link.along * along + link.across * Eigen::Vector2d(-along.y(), along.x());
  }
  return centres;
}

/// About the swing axis, with the upper structure: links and payload as points [kg m^2].
/// @param centre  cavity_centre() of its bucket
inline double swing_inertia(const Machine& machine, const Eigen::Vector2d& centre,
                            const JointAngles& joints, double payload) {
  const LinkPositions at = link_positions(machine, joints);
  const auto centres = link_centres(machine, at);
  double sum = machine.swing->inertia + payload * std::pow(bucket_point(at, centre).x(), 2);
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    sum += machine.links[i].mass * std::pow(centres[i].x(), 2);
  }
  return sum;
}

}  // namespace excavplan
