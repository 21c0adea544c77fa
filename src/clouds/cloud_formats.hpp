// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/clouds/cloud.hpp>

#include "clouds/point_stream.hpp"

/// @file The table of cloud formats: a new one is a file of its own and a line in
/// cloud_formats.cpp. Private to the library.

namespace excavplan {

constexpr std::size_t longest_header = 65536;  ///< of a PCD or PLY file [byte]
constexpr std::size_t most_fields = 64;        ///< of a point

/// Order of the points in a file.
struct CloudShape {
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::optional<Eigen::Vector3d> sensor = {};  ///< Cloud::sensor_origin
  std::uint64_t left_out = 0;                  ///< Cloud::left_out
  std::optional<double> unit = {};             ///< of the coordinates, where the file tells it [m]

  std::uint64_t points() const { return width * height; }
};
/// stream_cloud(), and how the points are ordered.
CloudShape stream_shape(const std::string& path, const PointVisitor& visit);

/// Passes on all points, the same on every call, and tells their order.
using OrderedPoints = std::function<CloudShape(const PointVisitor& visit)>;

/// Writes points, which are passed on twice, as write_cloud() does.
/// @throws Error (bad_file) also if they differ the second time
void write_points(const std::string& path, const OrderedPoints& source, const CloudFormat& format);

/// How the numbers of a file are written: with every digit, or binary.
enum class Numbers { text, float32, float64 };

/// A format of cloud files.
struct CloudFileFormat {
  std::string name;                  ///< CloudFormat::name
  std::string title;                 ///< for messages: "XYZ text"
  std::vector<std::string> endings;  ///< of file names, in small letters; at least one
  /// True if a file is of this format, detected from its first bytes without consuming them.
  bool (*holds)(FileStream& file);
  /// Reads a file of this format. @throws Error (bad_file)
  CloudShape (*stream)(FileStream& file, PointSink& sink);
  /// What a file holds before the rows of its points; null of a format that is read only.
  std::string (*head)(const CloudShape& shape, Numbers numbers);
  /// Cloud::sensor_origin from the head of a file; null where the format has none.
  std::optional<Eigen::Vector3d> (*sensor)(FileStream& file) = nullptr;
  bool is_text = false;  ///< always, so that no file is binary
};

/// In the order in which a file's content is tried.
const std::vector<CloudFileFormat>& cloud_file_formats();

/// What shows that a file is no text.
struct ForeignContent {
  std::string place;
  std::string found;
  std::string hint;  ///< what to do with it, behind what was expected
};
std::optional<ForeignContent> foreign_content(FileStream& file);

}  // namespace excavplan
