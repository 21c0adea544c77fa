// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/ground/map_files.hpp>

/// @file
/// GeoTIFF by GDAL, which is loaded when it is first needed: to start a program with it takes some
/// 60 ms. Private to the project.

namespace excavplan {

/// Why no GeoTIFF can be written here; empty if it can.
std::string lack_of_geotiff();

/// The bytes of a map's file.
/// @throws Error (bad_input) where there is a lack; (bad_file) with GDAL's reason
std::string geotiff_of(const LayeredMap& map, const std::string& file);

}  // namespace excavplan
