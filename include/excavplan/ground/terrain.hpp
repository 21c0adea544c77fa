// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <excavplan/base/warning.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file
/// The ground that a simulator digs, and measures of a dig on its surface.

namespace excavplan {

/// Ground in two layers on one grid, and what stands on it. Unknown cells are NaN in `bank`; no
/// soil enters or leaves them.
struct Terrain {
  HeightMap bank;         ///< top of the undisturbed soil [m]
  Eigen::ArrayXXd loose;  ///< thickness of the loose soil on it [m], >= 0, same size

  /// Void ratio of the undisturbed soil, constant over the depth of a cell, in the soil's
  /// void_ratio_min .. void_ratio_max [-]. Empty: the simulator's density everywhere.
  Eigen::ArrayXXd bank_void_ratio{};
  /// Void ratio of the loose layer, in the soil's void_ratio_min .. void_ratio_loose [-]. Empty:
  /// void_ratio_loose everywhere, to which all soil swells that is dug or slides.
  Eigen::ArrayXXd loose_void_ratio{};
  /// Top of what stands on the ground or hangs over it and is no soil: a wall, a machine, a person,
  /// a wire [m]; NaN where nothing does. The ground below is not seen: `bank` is NaN. A machine
  /// keeps clear of all that is below the top. Empty: nothing anywhere.
  Eigen::ArrayXXd obstacles{};
  /// Highest return of each of these, which may be lower than the top that is counted [m]. Empty:
  /// the tops are returns.
  Eigen::ArrayXXd obstacle_returns{};
  /// Of obstacles so thin, wires and posts, that rays pass beside them: that ground is seen in
  /// their place later does not tell that they have gone. Empty: none.
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> thin_obstacles{};
  /// What is doubtful about the ground, as who made it knows (terrain_from_scan()): becomes part of
  /// every plan on it.
  std::vector<Warning> doubts{};

  /// bank + loose. @throws Error (bad_input) if they differ in size
  HeightMap surface() const;
  /// The surface, and where something stands its top. @throws Error (bad_input) likewise
  HeightMap highest() const;
};

/// Undisturbed ground with this surface and no loose soil.
Terrain undisturbed(const HeightMap& surface);

/// A block of a terrain's cells in a new state.
struct TerrainPatch {
  Eigen::Index row = 0;              ///< of the block's first cell on the whole terrain
  Eigen::Index col = 0;              ///< likewise
  Eigen::ArrayXXd bank;              ///< top of the undisturbed soil [m]
  Eigen::ArrayXXd loose;             ///< [m]
  Eigen::ArrayXXd loose_void_ratio;  ///< empty if the terrain's is
};

/// Enters a patch into the terrain that it was made for.
/// @throws Error (bad_input) if the patch does not lie on the terrain, or its layers or those of
/// the
///         terrain differ in size
void apply(const TerrainPatch& patch, Terrain& terrain);

/// Volumes of a dig from the height maps, cell by cell, as the paper does in its simulator.
struct HeightMapVolumes {
  double excavated = 0.0;       ///< ground that fell [m^3]
  double spilled = 0.0;         ///< ground that rose away from the heap [m^3]
  double dumped = 0.0;          ///< ground that rose within `dump_radius` of the dump point [m^3]
  double bulking_factor = 0.0;  ///< (spilled + dumped) / excavated; 0 if nothing was excavated
};

/// The volumes between two states of a terrain. `dump_radius` in [m].
/// @throws Error (bad_input) if they are not on one grid, or point or radius are not finite
HeightMapVolumes height_map_volumes(const Terrain& before, const Terrain& after,
                                    const Eigen::Vector2d& dump_at, double dump_radius = 2.0);

/// Slope of the heap that rose at `at` [rad]: mean over 36 directions of its flank between a
/// quarter and three quarters of its radius. NaN if nothing rose there.
/// @throws Error (bad_input) as height_map_volumes()
double heap_slope(const Terrain& before, const Terrain& after, const Eigen::Vector2d& at);

}  // namespace excavplan
