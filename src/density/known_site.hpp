// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/change/known_ground.hpp>
#include <excavplan/density/density_options.hpp>
#include <excavplan/density/density_result.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/scans/ground_update.hpp>
#include <excavplan/scans/scan_surface.hpp>

/// @file
/// The known ground in a survey of a dig (docs/methods.md#known-ground). Private to the project.

namespace excavplan {

/// Deviation of loose soil in all cells alike where no path tells how much of it fell back, in this
/// dig and, as far as anyone knows, in those before [m]; ours.
inline constexpr double untold_loose_sd = 0.02;

/// Standard deviation of the height of a driven path, in known ground [m]; ours.
inline constexpr double known_tracking_sd = 0.02;

/// Points on each known cell of the ground, as a scan before that nobody made. @param near  what
/// another scan sees, to a metre around which the ground is told if enough of it is known
Scan scan_of(const GroundState& ground, const Rectangle& near);

/// Gives the surface of a scan of scan_of() the deviations of the ground.
void set_deviation(const GroundState& ground, Surface& before);

/// Leaves out what stood on the ground already and is no soil.
void leave_out_obstacles(const GroundState& ground, Surface& before);

/// Loose soil on the grid of a map. @param soil  whose loose state dug soil takes; null: unknown
KnownGround known_ground_on(const HeightMap& grid, const GroundState& ground, const SoilKind* soil);

/// Adds what a path cut of the bank. A cell at the edge of the bucket shows the mean of what was
/// cut and what stands beside: under the bucket its bank is that of the cell inside.
void add_cut(const DigPath& path, const Machine& machine, const HeightMap& before,
             KnownGround& known);

/// Soil that fell back in known ground, with the error of the path.
/// @return nothing where the cut has no bank
Fallback fallback_in(const KnownCut& cut);

/// A dig in known ground.
struct DigInGround {
  const SurfacePair& surfaces;  ///< of the dig, registered
  const VolumeChange& change;
  const KnownGround& known;
  double fallback = 0.0;  ///< share of the cut that is expected on its floor, if that is not told
};

/// The ground after the dig.
GroundState ground_after(const DensityOptions& options, const DigInGround& dig);

}  // namespace excavplan
