// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_formats.hpp"

#include <algorithm>

namespace excavplan {

CloudFileFormat pcd_format();  // each in a file of its own: cloud_pcd.cpp
CloudFileFormat ply_format();
CloudFileFormat las_format();
CloudFileFormat xyz_format();

const std::vector<CloudFileFormat>& cloud_file_formats() {
  // xyz last: it takes every text.
  static const std::vector<CloudFileFormat> formats = {pcd_format(), ply_format(), las_format(),
                                                       xyz_format()};
  return formats;
}

std::optional<ForeignContent> foreign_content(FileStream& file) {
  struct Signature {
    std::string_view bytes;
    const char* name;
    const char* hint;
  };
  constexpr const char* name_topic =
      "; inspect-cloud FILE lists its topics, and writes one, FILE:TOPIC@TIME, as a cloud";
  constexpr Signature known[] = {
      {"ASTM-E57", "an E57 file",
       "; convert it by pdal translate in.e57 out.las, or CloudCompare -SILENT -O in.e57 "
       "-C_EXPORT_FMT PLY -SAVE_CLOUDS"},
      {"SQLite format 3", "a recording (ROS 2 bag) or another database", name_topic},
      {"\x89MCAP", "a recording (MCAP)", name_topic},
      {"#ROSBAG", "a recording (ROS 1 bag)", name_topic},
      {"\x89PNG", "a PNG image", "; depth-to-cloud reads depth images"}};
  for (const Signature& signature : known) {
    if (file.peek(signature.bytes.size()) == signature.bytes) {
      return ForeignContent{"byte 0", signature.name, signature.hint};
    }
  }
  const std::string_view start = file.peek(longest_line);
  const auto odd = std::find_if(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\n' && c != '\r';
  });
  if (odd == start.end()) return std::nullopt;
  return ForeignContent{"byte " + std::to_string(odd - start.begin()),
                        "the byte " + std::to_string(static_cast<unsigned char>(*odd)), ""};
}

}  // namespace excavplan
