// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/clouds/cloud.hpp>
#include <excavplan/ground/surface.hpp>

#include "clouds/point_stream.hpp"

/// @file Points to the heights of cells, and what is known beside them. Private to the library.

namespace excavplan {

/// The grid of rasterise(), without heights. @throws Error (bad_input) as rasterise()
HeightMap empty_map(const Rectangle& extent, const RasterOptions& options);

/// The surface of points on this grid, as survey_surface() says; the points are passed on several
/// times.
Surface surface_of(const PointSource& source, const HeightMap& map, const RasterOptions& options);

}  // namespace excavplan
