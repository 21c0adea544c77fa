// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <excavplan/ground/layered_map.hpp>

#include "base/input_file.hpp"

/// @file
/// GeoTIFF. Written without GDAL, which takes 60 ms to load and would have to be loaded at run
/// time. Private to the project.

namespace excavplan {

/// A text about a whole file, in its GDAL metadata.
struct MapNote {
  std::string key;  ///< small letters, digits and _
  std::string value;
};
using MapNotes = std::vector<MapNote>;

/// The metadata of a file as it stands in it, which names bands and notes.
std::string geotiff_metadata(const LayeredMap& map, const MapNotes& notes);

/// All of a file before its first row. Of the layers their names and meanings are taken.
/// @throws Error (bad_input) if the file would have 4 GiB or more, where TIFF ends
std::string geotiff_head(const LayeredMap& map, const MapNotes& notes = {});

/// The bytes of a row of a band as the file has them; what is not finite is NaN.
std::string geotiff_row(const Eigen::ArrayXXd& values, Eigen::Index row);

/// Hands on the file of a map part by part: TIFF 6.0 with the tags of OGC GeoTIFF 1.1 and those by
/// which GDAL knows names, units and NODATA; bands one after another, not compressed, the row of
/// largest y first. @throws Error (bad_input) as geotiff_head()
void append_geotiff(const LayeredMap& map, const std::function<void(std::string_view)>& append,
                    const MapNotes& notes = {});

/// What the first directory of a file says, if it is such a file.
struct GeotiffSummary {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<std::string> bands;  ///< their names
  MapNotes notes;
};
/// Whether other fields and all values are as append_geotiff() writes them, the caller tells by
/// geotiff_head(). @throws Error (bad_file) naming file, place and rule
GeotiffSummary read_geotiff_summary(const InputFile& file);

}  // namespace excavplan
