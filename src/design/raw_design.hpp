// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

/// @file Readers of design files, one of each format. Private to the library.

namespace excavplan {

struct DesignFileOptions;

/// The triangles of a file, x to the east and y to the north, in the units of the file.
struct RawDesign {
  std::string name;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::optional<double> unit;         ///< of x and y [m]
  std::optional<double> height_unit;  ///< of z, if it differs [m]
  std::string unit_told_by;
  std::vector<std::string> notes;

  /// Parts a face of three or more corners into triangles about its first corner.
  void add_face(const std::vector<std::uint32_t>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
};

/// Ceilings of a design, ours: 24 and 12 bytes each.
inline constexpr std::uint64_t most_design_points = 50000000;
inline constexpr std::uint64_t most_design_triangles = 50000000;

RawDesign read_land_xml(const std::string& path, const DesignFileOptions& options);
RawDesign read_dxf(const std::string& path, const DesignFileOptions& options);
RawDesign read_ply_design(const std::string& path);
RawDesign read_obj(const std::string& path);
RawDesign read_stl(const std::string& path);

}  // namespace excavplan
