// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <excavplan/simulation/soil_simulator.hpp>

namespace excavplan {

/// A block of cells, upper ends exclusive.
struct CellBlock {
  Eigen::Index row_begin = 0;
  Eigen::Index row_end = 0;
  Eigen::Index col_begin = 0;
  Eigen::Index col_end = 0;

  void include(Eigen::Index row, Eigen::Index col);
  bool contains(Eigen::Index row, Eigen::Index col) const {
    return row >= row_begin && row < row_end && col >= col_begin && col < col_end;
  }
  bool empty() const { return row_begin >= row_end || col_begin >= col_end; }
};

/// How steep the two layers may stand.
struct SlopeLimits {
  double loose_slope = 0.0;      ///< tangent of the angle of repose
  double bank_slope = 0.0;       ///< tangent of the friction angle of the undisturbed soil
  double critical_height = 0.0;  ///< of a vertical wall in the undisturbed soil [m]
  double swell = 1.0;            ///< loose volume per bank volume
};

/// Lets soil slide where it stands too steep, but neither onto nor off the cells of `wall`, inside
/// `block` and one cell around it, which grows as soil leaves it. At most `sweeps` passes; returns
/// the block that may still move, empty once all is at rest. Solids are conserved to rounding;
/// unknown cells are walls.
CellBlock slump(Terrain& terrain, CellBlock block, const SlopeLimits& limits, int sweeps,
                const CellBlock& wall = {});

/// Heaps `volume` of loose soil on the terrain as a cone of the given slope with its axis at (x,
/// y).
/// @throws Error (bad_input) if the axis is off the map or on unknown ground
void pour(Terrain& terrain, const Eigen::Vector2d& at, double volume, double slope);

}  // namespace excavplan
