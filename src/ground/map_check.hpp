// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/surface.hpp>

/// @file
/// What functions ask of the maps that they are given. Private to the project.

namespace excavplan {

/// A height or thickness farther from zero is none [m]; ours.
inline constexpr double farthest_height = 1e6;

/// @throws Error (bad_input) "WHAT: ..." unless the map holds a cell, its cell size is in
///         1e-6 .. 1e6 m and its origin within 1e9 m
void require_grid(const HeightMap& map, const char* what);
/// The same, and every height is NaN or within farthest_height.
void require_map(const HeightMap& map, const char* what);
/// As require_map(); its other layers are empty or as large as the map, and places finite.
void require_surface(const Surface& surface, const char* what);

}  // namespace excavplan
