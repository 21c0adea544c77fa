// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Heights of a raster file, in its own units.
struct RasterFile {
  HeightMap map;  ///< NODATA is NaN
  /// Length of a unit of x, y and cell, where the file tells it [m].
  std::optional<double> unit = {};
  /// Length of a unit of height, where the file tells it [m].
  std::optional<double> height_unit = {};
};

/// Whether a file begins as one that read_raster() reads. @throws Error (bad_file) if it cannot be
/// read or is empty
bool is_raster(const std::string& path);

/// Reads an ESRI ASCII grid (read_ascii_grid()) or the first band of a GeoTIFF, told by its
/// content. GeoTIFF: TIFF or BigTIFF of either byte order, strips or tiles, numbers of 8 to 64
/// bits, not compressed or by PackBits, LZW or Deflate; north is up, cells are square, the
/// coordinates are not degrees. At most most_cells.
/// @throws Error (bad_file) naming file, line or byte, value and rule
RasterFile read_raster(const std::string& path);

}  // namespace excavplan
