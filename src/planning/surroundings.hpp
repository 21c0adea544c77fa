// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/kinematics.hpp>
#include <excavplan/machine/motion.hpp>

/// @file
/// What boom, arm and bucket pass over off the dig (docs/methods.md#motion).

namespace excavplan {

/// How far the machine is above the ground, and where that is least.
struct Clearance {
  double height = std::numeric_limits<double>::infinity();  ///< [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();          ///< of the ground [m]
};

/// Ground that no scan shows and that arm and bucket pass over.
struct UnseenGround {
  using Cells = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

  double area = 0.0;                                ///< [m^2]
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< of it on the way [m]
  Cells cells;                                      ///< that count already
};

/// The ground that the machine can pass over, what stands on it, and its own undercarriage, which
/// does not turn. Boom and arm are taken to be as wide as the bucket, and nothing passes below what
/// hangs over the ground: boom tops and the heap of a load need no look of their own.
///
/// Heights are compared at points so close that, together with the margin to every side, no cell
/// passes between them.
class Surroundings {
 public:
  Surroundings(const Machine& machine, const Terrain& ground);

  /// Where this ground is known it takes the place of the one before; what stands on it stays.
  void replace(const HeightMap& by);

  /// Of the machine where it stands. Cells at its rim count as low as the lowest beside them, and
  /// unseen ground does not count: it may stand in a trench.
  Clearance standing(const FrontJoints& joints) const;

  /// Where the machine comes within the margin of the ground on a straight way.
  std::optional<Clearance> obstacle(const FrontJoints& from, const FrontJoints& to) const;

  /// Likewise from where it stands, on the ground or in a trench: until it is clear of the ground
  /// it must not come deeper than it stands.
  std::optional<Clearance> obstacle_leaving(const FrontJoints& from, const FrontJoints& to) const;

  /// Adds the unseen ground of a straight way.
  void pass(const FrontJoints& from, const FrontJoints& to, UnseenGround& unseen) const;

  /// Where the tail, or the upper structure beside it, comes within the margin of what stands
  /// beside the tracks and higher than these. What is in the upper structure where the way begins
  /// is of the machine itself.
  std::optional<Clearance> tail_obstacle(const FrontJoints& from, const FrontJoints& to) const;

  double track_top() const;  ///< over the ground [m]
  bool on_undercarriage(double x, double y) const { return undercarriage_.contains(x, y); }
  /// Whether something stands there, or within the margin.
  bool stands_at(double x, double y) const;

 private:
  using Heights = Eigen::ArrayXXd;

  Clearance margin_at(const FrontJoints& joints) const;
  double parts(const FrontJoints& from, const FrontJoints& to, double spacing) const;
  void put_undercarriage();
  void put_beside();
  template <typename Visit>
  void visit(const FrontJoints& joints, double spacing, const double& too_high, Visit visit) const;
  template <typename Height>
  Clearance least(const FrontJoints& joints, double spacing, double most, Height height_of) const;

  const Machine& machine_;
  Rectangle undercarriage_;
  double own_radius_;                    ///< of the circle through the corners of the tracks [m]
  HeightMap seen_;                       ///< the highest ground of each cell
  Heights standing_;                     ///< tops of obstacles; -infinity: none
  Heights stands_;                       ///< of these within the margin
  std::vector<Eigen::Vector3d> beside_;  ///< tops that the upper structure may hit [m]
  double cells_of_margin_;
  Heights highest_;  ///< within the margin; unseen ground as the plane of the tracks
  Heights lowest_;   ///< of a cell and those beside it; unseen: -infinity
  double top_;       ///< of highest_ [m]
  double near_;      ///< between points that find what highest_ holds [m]
  double fine_;      ///< that find every cell [m]
};

}  // namespace excavplan
