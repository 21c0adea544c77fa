// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_formats.hpp"

#include <algorithm>

namespace excavplan {

CloudFileFormat pcd_format();  // each in a file of its own: cloud_pcd.cpp
CloudFileFormat ply_format();
CloudFileFormat las_format();
CloudFileFormat geotiff_format();  // raster_file.cpp
CloudFileFormat ascii_grid_format();
CloudFileFormat obj_format();
CloudFileFormat xyz_format();

const std::vector<CloudFileFormat>& cloud_file_formats() {
  // xyz last: it takes every text.
  static const std::vector<CloudFileFormat> formats = {
      pcd_format(),        ply_format(), las_format(), geotiff_format(),
      ascii_grid_format(), obj_format(), xyz_format()};
  return formats;
}

namespace {

/// What a text is that begins as a LandXML file, another XML file or a DXF drawing does; null of
/// others.
const char* text_format(std::string_view start) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (start.substr(0, 3) == byte_order_mark) start.remove_prefix(3);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (start.find("<LandXML") != start.npos) return "a LandXML file";
  if (start.substr(0, 5) == "<?xml") return "an XML file";
  const std::string_view first = start.substr(0, start.find_first_of(" \t\r\n"));
  start.remove_prefix(first.size());
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  // a group code and its value, each on a line of its own
  const bool is_dxf = first == "0" && start.substr(0, 7) == "SECTION";
  return is_dxf ? "a DXF drawing" : nullptr;
}

}  // namespace

std::optional<ForeignContent> foreign_content(FileStream& file) {
  struct Signature {
    std::string_view bytes;
    const char* name;
    const char* hint;
  };
  constexpr const char* name_topic =
      "; inspect-cloud FILE lists its topics, and writes one, FILE:TOPIC@TIME, as a cloud";
  constexpr const char* drawn =
      "; export its points as text, one x y z a line, from the program that draws it";
  constexpr Signature known[] = {
      {"ASTM-E57", "an E57 file",
       "; convert it by pdal translate in.e57 out.las, or CloudCompare -SILENT -O in.e57 "
       "-C_EXPORT_FMT PLY -SAVE_CLOUDS"},
      {"SQLite format 3", "a recording (ROS 2 bag) or another database", name_topic},
      {"\x89MCAP", "a recording (MCAP)", name_topic},
      {"#ROSBAG", "a recording (ROS 1 bag)", name_topic},
      {"\x89PNG", "a PNG image", "; depth-to-cloud reads depth images"},
      {"AutoCAD Binary DXF", "a DXF drawing", drawn},
      {"AC10", "a DWG drawing", drawn},
      {"PK\x03\x04", "a ZIP archive", "; unpack it"},
      {"\x1F\x8B", "a file compressed by gzip", "; unpack it by gunzip"}};
  for (const Signature& signature : known) {
    if (file.peek(signature.bytes.size()) == signature.bytes) {
      return ForeignContent{"byte 0", signature.name, signature.hint};
    }
  }
  const std::string_view start = file.peek(longest_line);
  if (const char* const name = text_format(start)) return ForeignContent{"byte 0", name, drawn};
  const auto odd = std::find_if(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\n' && c != '\r';
  });
  if (odd == start.end()) return std::nullopt;
  return ForeignContent{"byte " + std::to_string(odd - start.begin()),
                        "the byte " + std::to_string(static_cast<unsigned char>(*odd)), ""};
}

}  // namespace excavplan
