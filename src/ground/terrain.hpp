// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/terrain.hpp>

namespace excavplan {

/// @throws Error (bad_input) "WHAT: ..." unless the bank's grid is one (require_grid()) and all
///         layers have its size. Heights are checked where a dig reads them.
void require_terrain(const Terrain& terrain, const char* what);

/// @throws Error (bad_input) unless a patch lies on the terrain and its layers fit; an empty one
/// does
void require_patch(const TerrainPatch& patch, const Terrain& terrain);

}  // namespace excavplan
