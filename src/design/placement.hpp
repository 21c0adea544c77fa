// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/design/design_surface.hpp>
#include <excavplan/ground/height_map.hpp>

/// @file Whether a design lies on the ground that it is for. Private to the library.

namespace excavplan {

/// @throws Error (bad_file) with what would make it fit unless at least this share of the design's
/// area lies on known ground, near its height
void require_placement(const DesignSurface& design, const HeightMap& ground, double least_share);

}  // namespace excavplan
