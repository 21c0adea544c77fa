// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/layered_map.hpp>

/// @file
/// Maps and lines as files of CloudCompare, QGIS, MeshLab and CAD (docs/formats.md#maps). All are
/// in metres in the site frame, x to the right and y up: the first row of a raster is the one of
/// largest y.

namespace excavplan {

/// Points in their order, joined by straight lines.
struct MapLine {
  std::string name;                     ///< "tip_path"; small letters, digits and _
  std::vector<Eigen::Vector3d> points;  ///< finite [m], at least two
  bool is_closed = false;               ///< the last point is joined to the first
};

/// ".tif", ".ply" and ".asc".
const std::vector<std::string>& map_endings();
/// ".dxf" and ".ply".
const std::vector<std::string>& line_endings();

/// For a check before long work.
/// @throws Error (bad_input) if the ending is none of map_endings(), in letters of either size; if
///         it is .asc, which holds one layer, and there are more
void require_map_format(const std::string& file, std::size_t layers);
/// The same of line_endings().
void require_line_format(const std::string& file);

/// Writes layers in the format of the ending; what is not known is NODATA.
///
/// .tif: GeoTIFF of float64, a band for each layer with its name; NODATA is NaN. A cell is an area,
/// the origin is the outer corner of the first. The coordinate system is a local one in metres.
/// .asc: ESRI ASCII grid, registered by the outer corner of its cells; NODATA is -9999.
/// .ply: a point at the centre of each cell whose height is known, with a property scalar_NAME for
/// each layer, NaN where that is not known; float64, little endian.
///
/// @throws Error (bad_input) as require_map_format(), or if the grid is empty, a name is none, a
/// layer
///         is not of its size, or a GeoTIFF would have 4 GiB or more; (bad_file) if it cannot be
///         written: the old file then remains
void write_map(const std::string& file, const LayeredMap& map);

/// Writes lines in the format of the ending. .dxf: a 3D polyline each, in a layer with its name
/// (AutoCAD R12). .ply: its points as vertices, joined by edges; float64, little endian.
///
/// @throws Error (bad_input) as require_line_format(), or if a name is none or a line has fewer
/// than
///         two points or one that is not finite; (bad_file) if it cannot be written
void write_lines(const std::string& file, const std::vector<MapLine>& lines);

}  // namespace excavplan
