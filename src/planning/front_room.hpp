// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/kinematics.hpp>

namespace excavplan {

/// Ground that boom or arm would pass through.
struct FrontContact {
  const char* link = "";  ///< "boom", "arm" or "bucket"
  double x = 0.0;         ///< of the ground [m]
  double z = 0.0;         ///< of the ground [m]
  double lowest = 0.0;    ///< height of the link's lower side there [m]
};

/// "the boom would pass through the ground at x = 2.5 m, ..."
std::string describe(const FrontContact& contact);

/// The room that the ground ahead of the tracks leaves to boom and arm, and what stands on it to
/// the bucket too, at 0.1 m to every side.
///
/// Their lower sides are the lines from pin to pin: their bodies lie above these
/// (LinkMass::across).
class FrontRoom {
 public:
  FrontRoom(const Terrain& terrain, const Machine& machine);

  /// The first contact of this posture, if there is one.
  std::optional<FrontContact> contact(const LinkPositions& at) const;

 private:
  std::optional<FrontContact> contact(const char* link, const Eigen::Vector2d& from,
                                      const Eigen::Vector2d& to,
                                      const std::vector<double>& heights) const;

  const Machine& machine_;
  double origin_;
  double cell_size_;
  std::vector<double> heights_;   ///< per column: of what is highest under the links
  std::vector<double> standing_;  ///< of what stands there, for the bucket too; empty: nothing
  double highest_;
};

}  // namespace excavplan
