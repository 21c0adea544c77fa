// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>

/// @file
/// What stands on the ground, told from it by its shape.

namespace excavplan {

/// Height above the ground around it from which something is an obstacle [m]; ours, as of what
/// estimate_density() takes out of scans.
constexpr double least_obstacle = 0.5;

using CellMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Cells of what stands more than least_obstacle above the ground around it, with faces steeper
/// than 60 degrees: posts, walls, boxes, vehicles, however wide, up to 20 m² (ours). Not the rim of
/// a pit or a bench, which ground of its own height adjoins, and nothing that goes on over the edge
/// of the map without a face.
/// @param highest  of each cell; NaN: unknown
CellMask find_obstacles(const HeightMap& highest);

/// The highest of what stands in a part of a terrain.
struct ObstacleTop {
  Eigen::Vector2d place;  ///< where it is counted highest [m]
  double counted;         ///< Terrain::obstacles [m]
  double seen;            ///< highest return [m]
};
/// @param in_part  of places; nothing if nothing stands there
std::optional<ObstacleTop> highest_obstacle(
    const Terrain& terrain, const std::function<bool(const Eigen::Vector2d&)>& in_part);
/// Likewise in a square about a place, to so far from it [m].
std::optional<ObstacleTop> highest_obstacle(const Terrain& terrain, const Eigen::Vector2d& about,
                                            double within);
/// "1.5 m high", or "1.5 m high by its highest return and counted up to 2.4 m".
std::string text(const ObstacleTop& top);

/// The terrain with what find_obstacles() finds on its surface, unless it has obstacles already.
Terrain with_obstacles(const Terrain& terrain);

}  // namespace excavplan
