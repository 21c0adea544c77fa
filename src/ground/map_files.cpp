// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/map_files.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/non_finite.hpp"
#include "base/scalar.hpp"
#include "base/text.hpp"
#include "ground/geotiff.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

using Append = std::function<void(std::string_view)>;

constexpr const char* ascii_nodata = "-9999";

std::string ending_of(const std::string& file) {
  return small_letters(std::filesystem::path(file).extension().string());
}

void require_ending(const std::string& file, const std::vector<std::string>& endings) {
  std::string rule;
  for (const std::string& ending : endings) {
    if (ending == ending_of(file)) return;
    rule += (rule.empty() ? "" : " or ") + ending;
  }
  refuse("'" + file + "' must end in " + rule);
}

void require_name(const std::string& name, const std::string& what) {
  const bool is_name =
      !name.empty() && name.size() <= longest_text &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  require(is_name, what + " " + in_quotes(name) + ": a name has small letters, digits and _");
}

void require_layers(const LayeredMap& map) {
  require_grid(map.ground, "map");
  require(!map.layers.empty(), "a map needs a layer");
  for (const MapLayer& layer : map.layers) {
    require_name(layer.name, "map layer");
    const bool fits =
        layer.values.rows() == map.ground.z.rows() && layer.values.cols() == map.ground.z.cols();
    require(fits, "map layer " + layer.name + " has another size than the grid");
    const auto fault = fault_of_line(layer.meaning, longest_text);
    require(!fault, "map layer " + layer.name + ": its meaning is " + fault.value_or(""));
  }
}

// ---- ESRI ASCII grid --------------------------------------------------------------------------

void append_ascii_grid(const HeightMap& grid, const Eigen::ArrayXXd& values, const Append& append) {
  append("ncols " + std::to_string(values.cols()) + "\nnrows " + std::to_string(values.rows()) +
         "\nxllcorner " + number_text(grid.origin.x()) + "\nyllcorner " +
         number_text(grid.origin.y()) + "\ncellsize " + number_text(grid.cell_size) +
         "\nNODATA_value " + ascii_nodata + '\n');
  for (Eigen::Index row = values.rows() - 1; row >= 0; --row) {
    std::string line;
    for (Eigen::Index col = 0; col < values.cols(); ++col) {
      const double value = values(row, col);
      if (col > 0) line += ' ';
      line += std::isfinite(value) ? number_text(value) : ascii_nodata;
    }
    append(line += '\n');
  }
}

// ---- PLY --------------------------------------------------------------------------------------

constexpr const char* ply_start =
    "ply\nformat binary_little_endian 1.0\ncomment excavplan, site frame, metres\n";

std::string ply_vertices(std::size_t count) {
  return "element vertex " + std::to_string(count) +
         "\nproperty double x\nproperty double y\nproperty double z\n";
}

/// Row by row, so that memory holds one.
void append_ply(const LayeredMap& map, const Append& append) {
  const HeightMap& ground = map.ground;
  std::string head =
      ply_start + ply_vertices(static_cast<std::size_t>(ground.z.isFinite().count()));
  for (const MapLayer& layer : map.layers) head += "property double scalar_" + layer.name + '\n';
  append(head + "end_header\n");
  for (Eigen::Index row = 0; row < ground.z.rows(); ++row) {
    std::string bytes;
    for (Eigen::Index col = 0; col < ground.z.cols(); ++col) {
      if (!std::isfinite(ground.z(row, col))) continue;
      for (const double place : {ground.x(col), ground.y(row), ground.z(row, col)}) {
        put(place, bytes);
      }
      for (const MapLayer& layer : map.layers) {
        const double value = layer.values(row, col);
        put(std::isfinite(value) ? value : nan, bytes);
      }
    }
    append(bytes);
  }
}

std::string ply_of(const std::vector<MapLine>& lines) {
  std::size_t points = 0;
  std::size_t edges = 0;
  std::string vertices;
  std::string joints;
  for (const MapLine& line : lines) {
    const auto first = static_cast<std::int32_t>(points);
    const auto count = static_cast<std::int32_t>(line.points.size());
    for (const Eigen::Vector3d& point : line.points) {
      for (const double place : point) put(place, vertices);
    }
    for (std::int32_t i = 0; i < (line.is_closed ? count : count - 1); ++i) {
      put(first + i, joints);
      put(first + (i + 1) % count, joints);
      ++edges;
    }
    points += line.points.size();
  }
  return ply_start + ply_vertices(points) + "element edge " + std::to_string(edges) +
         "\nproperty int vertex1\nproperty int vertex2\nend_header\n" + vertices + joints;
}

// ---- DXF --------------------------------------------------------------------------------------

std::string group(int code, const std::string& value) {
  return std::to_string(code) + '\n' + value + '\n';
}

std::string dxf_place(const Eigen::Vector3d& at) {
  return group(10, number_text(at.x())) + group(20, number_text(at.y())) +
         group(30, number_text(at.z()));
}

/// AutoCAD R12, the last version without tables that must be there.
std::string dxf_of(const std::vector<MapLine>& lines) {
  constexpr int is_3d = 8;
  std::string text = group(0, "SECTION") + group(2, "HEADER") + group(9, "$ACADVER") +
                     group(1, "AC1009") + group(0, "ENDSEC") + group(0, "SECTION") +
                     group(2, "ENTITIES");
  for (const MapLine& line : lines) {
    text += group(0, "POLYLINE") + group(8, line.name) + group(66, "1") +
            dxf_place(Eigen::Vector3d::Zero()) +
            group(70, std::to_string(is_3d + (line.is_closed ? 1 : 0)));
    for (const Eigen::Vector3d& point : line.points) {
      text += group(0, "VERTEX") + group(8, line.name) + dxf_place(point) + group(70, "32");
    }
    text += group(0, "SEQEND") + group(8, line.name);
  }
  return text + group(0, "ENDSEC") + group(0, "EOF");
}

}  // namespace

const std::vector<std::string>& map_endings() {
  static const std::vector<std::string> endings = {".tif", ".ply", ".asc"};
  return endings;
}

const std::vector<std::string>& line_endings() {
  static const std::vector<std::string> endings = {".dxf", ".ply"};
  return endings;
}

void require_map_format(const std::string& file, std::size_t layers) {
  require_ending(file, map_endings());
  require(layers == 1 || ending_of(file) != ".asc",
          "'" + file + "' would hold " + std::to_string(layers) + " layers, .asc holds one");
}

void require_line_format(const std::string& file) { require_ending(file, line_endings()); }

void write_map(const std::string& file, const LayeredMap& map) {
  require_map_format(file, map.layers.size());
  require_layers(map);
  const std::string ending = ending_of(file);
  if (ending == ".tif") {
    write_file(file, [&](const Append& append) { append_geotiff(map, append); });
  } else if (ending == ".ply") {
    write_file(file, [&](const Append& append) { append_ply(map, append); });
  } else {
    write_file(file, [&](const Append& append) {
      append_ascii_grid(map.ground, map.layers.front().values, append);
    });
  }
}

void write_lines(const std::string& file, const std::vector<MapLine>& lines) {
  require_line_format(file);
  for (const MapLine& line : lines) {
    require_name(line.name, "line");
    require(line.points.size() > 1, "line " + line.name + " needs two points");
    for (const Eigen::Vector3d& point : line.points) {
      require(point.allFinite(), "line " + line.name + " has a point that is not finite");
    }
  }
  write_file(file, ending_of(file) == ".dxf" ? dxf_of(lines) : ply_of(lines));
}

}  // namespace excavplan
