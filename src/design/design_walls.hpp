// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/base_pose.hpp>
#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// Whether the walls of a design stand once they are dug. Private to the project.

namespace excavplan {

/// Undisturbed soil beside a wall.
struct WallSoil {
  SoilState believed;  ///< counts for walls that rules let stand without a proof
  SoilState sure;      ///< as strong as it surely is: for others
};

/// What walls are looked at for.
struct WallTask {
  const HeightMap& target;        ///< height of the design; NaN beside it [m]
  const Eigen::ArrayXXd& before;  ///< of the ground before the job, on its cells [m]
  const Terrain& ground;          ///< with the spoil that lies on it
  WallSoil bank;
  SoilState loose;  ///< spoil
  const Machine& machine;
  std::optional<BasePose> base = {};  ///< of a machine that stands by
};

/// A wall of the design, in a section across its edge.
struct DesignWall {
  std::optional<Eigen::Vector2d> edge;  ///< where it is, if that is known [m]
  double height = 0.0;                  ///< [m]
  double batter = 0.0;                  ///< run over height
  double factor = 0.0;                  ///< of safety
  double least = 0.0;                   ///< that it needs
  std::optional<double> standing;       ///< batter that has it
};

/// The one that lacks most of the factor that it needs.
/// @param about   places, from the first straight to the next [m]; empty: all of the design
/// @param within  of these [m]
/// @return nothing if all stand
std::optional<DesignWall> weakest_wall(const WallTask& task,
                                       const std::vector<Eigen::Vector2d>& about = {},
                                       double within = 0.0);

/// A wall of that height and batter in level ground, with nothing beside it; nothing if it stands.
std::optional<DesignWall> weak_wall(const WallSoil& bank, double height, double batter);

/// An unstable_wall.
Warning warning_of(const DesignWall& wall);

}  // namespace excavplan
