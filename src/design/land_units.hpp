// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// @file The units of LandXML. Private to the library.

namespace excavplan {

struct LandUnits {
  double linear = 1.0;  ///< of northing and easting [m]
  double height = 1.0;  ///< of elevation [m]
  std::string told_by;  ///< "Units: foot"
  std::string fault;    ///< why they are none; else empty
};

/// @param system  "Metric" or "Imperial", whose lists of units differ
/// @param linear, height  the attributes; empty: not there
LandUnits land_units(const std::string& system, std::string_view linear, std::string_view height);

}  // namespace excavplan
