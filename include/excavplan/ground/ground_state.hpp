// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

#include <excavplan/ground/terrain.hpp>

/// @file
/// What is known of the ground, carried from dig to dig, and its file (docs/formats.md#ground).

namespace excavplan {

/// The ground as known at one time. Layers are as large as the terrain's bank; empty: not known.
struct GroundState {
  Terrain terrain;            ///< bank, loose soil, void ratios and obstacles
  Eigen::ArrayXXd seen;       ///< when a cell was last seen, since 1970-01-01 UTC [s]; NaN: never
  Eigen::ArrayXXd deviation;  ///< standard deviation of the surface, >= 0 [m]; NaN: not known
  std::string frame;          ///< name of the site frame; empty: not told
  std::string soil;           ///< name of the kind that the void ratios are of; empty: not told
};

/// @throws Error (bad_input) "WHAT: ..." unless all layers are as large as the bank, every number
///         is NaN or within its bounds, and the names are lines of text
void require_ground_state(const GroundState& state, const char* what);

/// The state once a dig has changed its terrain, on the same grid. How well a cell is known whose
/// surface the dig changed is not known: its deviation is NaN; when it was seen stays. So do the
/// void ratios of the bank, which no dig changes.
/// @throws Error (bad_input) unless the terrains are on one grid
GroundState after_dig(GroundState state, const Terrain& after);

/// Writes a state whole or not at all, as a GeoTIFF with a band of float64 for each layer that
/// GDAL and QGIS open. Every number comes back as it was, NaN as NaN.
/// @throws Error (bad_input) as require_ground_state(), or if the file would have 4 GiB or more;
///         (bad_file) if it cannot be written: the old file then remains
void save_ground(const std::string& file, const GroundState& state);

/// Reads a file that save_ground() wrote. load_ground() with a soil (soil/ground_in_soil.hpp) also
/// reads the grids of other programs.
/// @throws Error (bad_file) naming file, place and rule if it is no such file, cut off or damaged
GroundState load_ground(const std::string& file);

}  // namespace excavplan
