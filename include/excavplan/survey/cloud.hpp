// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Points of a scan [m]. Points that are not finite are kept in the order of the file, as an
/// organised cloud needs them; functions that measure leave them out.
struct Cloud {
  std::vector<Eigen::Vector3d> points;
  std::size_t width = 0;   ///< of an organised cloud, else points.size()
  std::size_t height = 1;  ///< 1 unless organised
};

enum class CloudFormat { pcd_ascii, pcd_binary, ply_ascii, ply_binary, xyz };

/// Reads PCD (ascii, binary, binary_compressed), PLY (ascii, binary little and big endian) or XYZ
/// text; the format is told from the content, not from the name.
///
/// x, y and z may be float32, float64 or integers; other fields are skipped. Every rule of
/// docs/formats.md#clouds is checked before memory is asked for.
///
/// @throws Error (bad_file) naming file, line or byte, what was found and what was expected
Cloud read_cloud(const std::string& path);

/// Writes a cloud; binary formats hold float64 if a coordinate needs it (float32 would move a point
/// by more than 0.1 mm), else float32.
///
/// The file appears whole or not at all (written beside, then renamed).
/// @throws Error (bad_file) if the file cannot be written
void write_cloud(const std::string& path, const Cloud& cloud, CloudFormat format);

/// The format a file name asks for: .pcd and .ply binary, .xyz .txt .asc text.
/// @throws Error (bad_input) for any other ending
CloudFormat cloud_format_of_name(const std::string& path);

/// Reads a 4 x 4 matrix of text that takes a scan into the site frame.
/// @throws Error (bad_file) if it is not 16 numbers, the last row is not 0 0 0 1, or it is not
/// rigid
Eigen::Matrix4d read_frame(const std::string& path);

void transform(Cloud& cloud, const Eigen::Matrix4d& site_from_scan);

/// What is in a cloud.
struct CloudSummary {
  std::size_t points = 0;
  std::size_t finite_points = 0;
  Eigen::Vector3d centroid =
      Eigen::Vector3d::Zero();  ///< over the finite points [m]; NaN if there are none
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
  double density = 0.0;     ///< points per m^2 of occupied ground
  std::string frame_guess;  ///< "site (z up, ground near 0)", "map (large coordinates)", "camera (z
                            ///< forward)", "unknown"
};
CloudSummary summarise(const Cloud& cloud);

/// Settings of rasterise().
struct RasterOptions {
  double cell = 0.05;  ///< [m], > 0
  double outlier_distance =
      4.0;  ///< points farther from the cell's median than this many robust sd are left out [-]
};

/// One height per cell of the grid that starts at `extent` (its lower corner snapped to a multiple
/// of the cell): the mean of the points near the cell's median, moved to the cell's centre by the
/// local slope; NaN without points.
///
/// @throws Error (bad_input) if an option is out of range or the map would hold more than 100
/// million cells
HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options = {});

/// Plan extent of the finite points, without the farthest 0.1 % on each side, widened to what holds
/// them.
/// @throws Error (bad_input) if no point is finite
Rectangle plan_extent(const Cloud& cloud);

}  // namespace excavplan
