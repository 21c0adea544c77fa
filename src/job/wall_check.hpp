// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/soil/soil.hpp>

#include "job/job_map.hpp"

/// @file
/// Whether the walls of a design stand once they are dug. Private to the project.

namespace excavplan {

/// What walls are looked at for.
struct WallTask {
  const JobSettings& settings;
  const JobMap& map;
  const Terrain& ground;         ///< with the spoil that lies on it
  std::optional<BasePose> base;  ///< of a machine that stands by
  double strength_factor = 1.0;  ///< on the soil's strength, as it is surely known
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

/// Undisturbed soil as strong as it surely is before any dig told of it.
SoilState surely_strong(const SoilKind& soil, double density_percent);

/// A wall of that height and batter in level ground, with nothing beside it; nothing if it stands.
std::optional<DesignWall> weak_wall(const SoilState& bank, double height, double batter);

/// An unstable_wall.
Warning warning_of(const DesignWall& wall);

}  // namespace excavplan
