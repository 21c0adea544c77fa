// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/design/design_surface.hpp>

namespace excavplan {

/// What a file of a design does not say itself.
struct DesignFileOptions {
  /// Of several surfaces of a LandXML file, the one of this name; empty: the only one, or of
  /// several the only one that is no existing ground. Of a DXF drawing a layer, if no others are.
  std::string surface;
  /// Layers of a DXF drawing that are read; empty: all.
  std::vector<std::string> layers;
  /// Length of a unit of the coordinates [m]; unset: as the file tells, or a metre.
  std::optional<double> unit;
  Eigen::Matrix4d site_from_design = Eigen::Matrix4d::Identity();  ///< [m]; turns about z alone
};

/// Reads a design surface, of a format told by its content (docs/formats.md#designs):
///
/// LandXML 1.0 to 2.0: the visible triangles of a TIN; a point is northing, easting, elevation.
/// DXF of text: 3DFACE and polyface meshes, in blocks too. PLY, OBJ and STL: their faces. ESRI
/// ASCII grid and GeoTIFF: a cell is level.
///
/// @throws Error (bad_file) naming file, line or byte, what was found and the rule; (bad_input) if
/// an option is out of range
DesignSurface read_design(const std::string& path, const DesignFileOptions& options = {});

}  // namespace excavplan
