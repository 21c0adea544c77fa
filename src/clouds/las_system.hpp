// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

/// @file What the coordinate system of a LAS file says of its coordinates. Private to the library.

namespace excavplan {

/// What a record tells; nothing of what it is silent on.
struct LasSystem {
  /// Why x, y and z are not those of a plane with z up: "geographic coordinates (degrees)"; null if
  /// they are.
  const char* not_plane = nullptr;
  std::optional<double> plan_unit = {};  ///< of x and y [m]
  std::optional<double> up_unit = {};    ///< of z [m]
};

/// From a GeoKeyDirectoryTag (OGC 19-008r4, GeoTIFF 1.1): keys 1024, 3076 and 4099.
LasSystem system_of_geokeys(std::string_view record);

/// The units of length of EPSG that GeoTIFF names [m].
std::optional<double> length_of_epsg(unsigned code);

/// From well-known text (OGC 01-009 and ISO 19162).
LasSystem system_of_wkt(std::string_view record);

}  // namespace excavplan
