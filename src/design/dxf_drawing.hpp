// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// @file The faces of a DXF drawing of text, before blocks are placed. Private to the library.

namespace excavplan {

/// A triangle or a quadrangle, whose last two corners differ.
struct DxfFace {
  std::array<Eigen::Vector3d, 4> corners;
  std::string layer;
};

/// A block in its place, once or in rows and columns.
struct DxfInsert {
  std::string block;
  std::string layer;
  std::uint64_t line = 0;
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  ///< of the block, its base taken off
  int columns = 1;
  int rows = 1;
  Eigen::Vector2d spacing = {0.0, 0.0};
};

struct DxfBlock {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  std::vector<DxfFace> faces;
  std::vector<DxfInsert> inserts;
};

struct DxfDrawing {
  DxfBlock entities;
  std::map<std::string, DxfBlock> blocks;
  std::optional<int> unit_code;               ///< $INSUNITS
  std::map<std::string, std::size_t> unread;  ///< entities of other kinds, by kind
};

/// @throws Error (bad_file) naming file, line, what was found and what was expected
DxfDrawing read_dxf_drawing(const std::string& path);

}  // namespace excavplan
