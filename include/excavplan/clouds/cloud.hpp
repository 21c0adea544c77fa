// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Points of a scan [m]. Points that are not finite are kept in the order of the file, as an
/// organised cloud needs them; functions that measure leave them out.
struct Cloud {
  std::vector<Eigen::Vector3d> points;  ///< in the order of the file [m]
  std::size_t width = 0;                ///< of an organised cloud, else points.size()
  std::size_t height = 1;               ///< 1 unless organised
  /// Where the sensor stood, in the frame of the points [m]; unset where unknown.
  std::optional<Eigen::Vector3d> sensor_origin = {};
  std::size_t left_out = 0;  ///< further points of its file that do not count: those of LAS
};

/// How a cloud is written.
struct CloudFormat {
  std::string name;   ///< "pcd", "ply" or "xyz"
  bool text = false;  ///< every number with all its digits; else binary, where the format has it
};

/// Reads PCD (ascii, binary, binary_compressed), PLY (ascii, binary little and big endian), LAS
/// (1.0 to 1.4) or XYZ text; the format is detected from the content, not from the name. Of LAS,
/// points that are withheld or classified as noise are left out.
///
/// x, y and z may be float32, float64 or integers; other fields are skipped. Every rule of
/// docs/formats.md#clouds is checked before memory is allocated; a file that would take more than
/// `memory_limit` [byte] in all is refused.
///
/// @throws Error (bad_file) naming file, line or byte, what was found and what was expected
Cloud read_cloud(const std::string& path, std::uint64_t memory_limit = std::uint64_t{4} << 30);

/// Cloud::sensor_origin of a file, from its head alone: the VIEWPOINT of a PCD file that is not the
/// default 0 0 0 1 0 0 0; nothing of other formats. @throws Error (bad_file) as read_cloud()
std::optional<Eigen::Vector3d> read_sensor_origin(const std::string& path);

using PointVisitor = std::function<void(const std::vector<Eigen::Vector3d>& points)>;

/// Reads what read_cloud() reads, with the same errors, but hands the points on some thousand at a
/// time in the order of the file and keeps none, so that a file may be of any size. Points that
/// came before an error was found have been handed on.
///
/// @throws Error (bad_file) as read_cloud()
void stream_cloud(const std::string& path, const PointVisitor& visit);

/// Writes a cloud; binary formats hold float64 if a coordinate needs it (float32 would move a point
/// by more than 0.1 mm), else float32. Of the formats only PCD holds where the sensor stood.
///
/// The file appears whole or not at all (written beside, then renamed).
/// @throws Error (bad_file) if the file cannot be written; (bad_input) if the cloud's width and
/// height do not fit its points, or the format is none
void write_cloud(const std::string& path, const Cloud& cloud, const CloudFormat& format);

/// The format of a file name: .pcd and .ply binary, .xyz .txt .asc text.
/// @throws Error (bad_input) for any other ending
CloudFormat cloud_format_of_name(const std::string& path);
/// The supported endings, for help: ".pcd, .ply, .xyz, .txt or .asc".
std::string cloud_endings();

/// Reads what transforms a scan into the site frame: a 4 x 4 matrix of text, or a transform or pose
/// as ROS writes it, in JSON or YAML (docs/formats.md#frame).
/// @throws Error (bad_file) if it is none of these; if the matrix is not 16 numbers, its last row
/// not 0 0 0 1, or it is not rigid to 1e-4; if the quaternion's norm is not 1 to 1e-3
Eigen::Matrix4d read_frame(const std::string& path);

/// Writes what read_frame() reads, every number with all its digits. @throws Error (bad_file)
void write_frame(const std::string& path, const Eigen::Matrix4d& site_from_scan);

/// The rigid motion of a translation [m] and a quaternion (x, y, z, w), in the order of ROS. The
/// quaternion is normalised.
/// @throws Error (bad_input) if a number is not finite or the quaternion's norm is not 1 to 1e-3
Eigen::Matrix4d pose_of_quaternion(const Eigen::Vector3d& translation,
                                   const Eigen::Vector4d& quaternion);

/// Moves the points, and the sensor's place with them.
/// @throws Error (bad_input) if a number of the matrix is not finite
void transform(Cloud& cloud, const Eigen::Matrix4d& site_from_scan);

/// What is in a cloud.
struct CloudSummary {
  std::size_t points = 0;                              ///< of the cloud
  std::size_t width = 0;                               ///< Cloud::width
  std::size_t height = 1;                              ///< Cloud::height
  std::size_t left_out = 0;                            ///< Cloud::left_out
  std::size_t finite_points = 0;                       ///< without NaN and infinity
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< over the finite points [m]; NaN if there
                                                       ///< are none
  Eigen::Vector3d min = Eigen::Vector3d::Zero();  ///< smallest x, y and z of the finite points [m]
  Eigen::Vector3d max = Eigen::Vector3d::Zero();  ///< largest x, y and z of the finite points [m]
  std::optional<Rectangle> extent = {};           ///< as plan_extent(); none without finite points
  double density = 0.0;     ///< points per m^2 of occupied ground; NaN if they have no area
  std::string frame_guess;  ///< "site (z up, ground near 0)", "map (large
                            ///< coordinates)", "camera (z forward)", "unknown"
};

/// The frame is a guess for display only: "map" if the centroid is over 10 km from the
/// origin in plan, "camera" if nearly all points lie within 60 degrees of the z axis, ahead, "site"
/// if the layer of 0.25 m with most points is within 0.5 m of zero and the cloud is wider than
/// high.
CloudSummary summarise(const Cloud& cloud);

/// Settings of rasterise().
struct RasterOptions {
  double cell_size = 0.05;        ///< [m], > 0
  double outlier_distance = 4.0;  ///< points this many robust sd beyond the heights found around
                                  ///< their cell are left out [-], > 0
  std::uint64_t memory = std::uint64_t{128} << 20;  ///< for points held at a time [byte]; where
                                                    ///< it does not do, scans are read again
  Eigen::Vector2d node = {0.0, 0.0};                ///< where corners of cells meet [m]
};

/// One height per cell of the grid that covers `extent`, its lower corner snapped down to a
/// multiple of the cell from `node`, so that clouds rasterised with one extent share one grid.
///
/// The height is the mean of the cell's points that are no outliers, moved to the cell's centre by
/// the local slope; NaN without points. Outliers lie outside the band [low - g, high + g], low and
/// high the extreme medians of the 3 x 3 neighbourhood but for one on each side, which counts only
/// if it is that of the cell itself and of five points at least; g = outlier_distance * noise +
/// (high - low) / 2, noise the lower quartile of the cells' robust sd: the two levels of a cell
/// that a wall crosses both lie inside it, so that the volume between two maps stays unbiased.
/// Points farther from the plane through these medians than outlier_distance * noise and three
/// times what the medians are off it are outliers too. Where few cells hold five points nothing is
/// left out. survey_surface() says more, of which this is the height.
///
/// @throws Error (bad_input) if an option is out of range or the map would hold more than 100
/// million cells
HeightMap rasterise(const Cloud& cloud, const Rectangle& extent, const RasterOptions& options = {});

/// Plan extent of the finite points without the farthest 0.1 % on each side; contains() holds for
/// all others.
/// @throws Error (bad_input) if no point is finite
Rectangle plan_extent(const Cloud& cloud);

}  // namespace excavplan
