// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Reads an ESRI ASCII grid, whose lower left cell is placed by its corner or its centre; NODATA,
/// -9999 where the file does not say it, is NaN. Keys in letters of either size and any order,
/// values in lines of any length. At most most_cells.
/// @throws Error (bad_file) naming file, line, value and rule
HeightMap read_ascii_grid(const std::string& file);

}  // namespace excavplan
