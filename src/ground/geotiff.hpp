// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include <excavplan/ground/layered_map.hpp>

/// @file
/// GeoTIFF. Written without GDAL, which takes 60 ms to load and would have to be loaded at run
/// time. Private to the project.

namespace excavplan {

/// Hands on the file of a map part by part: TIFF 6.0 with the tags of OGC GeoTIFF 1.1 and those by
/// which GDAL knows names, units and NODATA; bands one after another, not compressed.
/// @throws Error (bad_input) if it would have 4 GiB or more, where TIFF ends
void append_geotiff(const LayeredMap& map, const std::function<void(std::string_view)>& append);

}  // namespace excavplan
