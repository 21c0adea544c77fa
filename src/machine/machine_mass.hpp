// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include <excavplan/machine/kinematics.hpp>

#include "machine/plane.hpp"

/// @file
/// Masses of a machine: all of it and what bears it, its front about the swing axis. Private to the
/// project.

namespace excavplan {

/// Of body and links; of the links alone where the body is not known [kg].
inline double total_mass(const Machine& machine) {
  double mass = machine.body ? machine.body->mass : 0.0;
  for (const LinkMass& link : machine.links) mass += link.mass;
  return mass;
}

/// Where the tracks lie on the ground, in the frame of the machine.
struct TrackPrint {
  /// Width of one track over that of both: 0.5 m of the zx120's.
  static constexpr double shoe_share = 0.2;

  explicit TrackPrint(const Machine& machine)
      : length(2.0 * machine.track_front),
        half(0.5 * machine.undercarriage_width()),
        shoe(2.0 * shoe_share * half) {}

  bool covers(double x, double y) const {
    const double beside = std::abs(y);
    return std::abs(x) <= 0.5 * length && beside <= half && beside >= half - shoe;
  }
  double area() const { return 2.0 * shoe * length; }  ///< of both [m^2]

  double length;  ///< [m]
  double half;    ///< from the middle to the outer side of a track [m]
  double shoe;    ///< width of a track [m]
};

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
