// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/las_system.hpp"

#include <algorithm>
#include <string>

#include "base/scalar.hpp"
#include "clouds/file_stream.hpp"

namespace excavplan {
namespace {

constexpr const char* geographic = "geographic coordinates (degrees of longitude and latitude)";
constexpr const char* geocentric = "geocentric coordinates (from the centre of the Earth)";

/// The node of well-known text that begins with one of these keywords, up to its closing bracket;
/// empty if there is none.
std::string_view node_of(std::string_view text, std::initializer_list<std::string_view> keywords) {
  for (const std::string_view keyword : keywords) {
    const std::size_t start = text.find(keyword);
    if (start == text.npos) continue;
    int depth = 0;
    for (std::size_t at = start; at < text.size(); ++at) {
      if (text[at] == '[') ++depth;
      if (text[at] == ']' && --depth == 0) return text.substr(start, at + 1 - start);
    }
    return text.substr(start);
  }
  return {};
}

/// The number of the last UNIT or LENGTHUNIT in a node: those before it are of the system below.
std::optional<double> unit_of(std::string_view node) {
  const std::size_t start = node.rfind("UNIT[\"");
  if (start == node.npos) return std::nullopt;
  const std::size_t comma = node.find(',', node.find('"', start + 6));
  const std::size_t end = node.find_first_of(",]", comma == node.npos ? comma : comma + 1);
  if (comma == node.npos || end == node.npos) return std::nullopt;
  std::string_view number = node.substr(comma + 1, end - comma - 1);
  const auto value = parse_number(take_word(number));
  return value && *value > 0.0 ? value : std::nullopt;
}

}  // namespace

std::optional<double> length_of_epsg(unsigned code) {
  if (code == 9001) return 1.0;              // metre
  if (code == 9002) return 0.3048;           // foot
  if (code == 9003) return 1200.0 / 3937.0;  // US survey foot
  return std::nullopt;
}

LasSystem system_of_geokeys(std::string_view record) {
  constexpr std::size_t entry_size = 8;  // four uint16: key, where its value is, count, value
  const auto number = [&](std::size_t at) {
    return load<std::uint16_t>(record.data() + at, false);
  };
  LasSystem system;
  for (std::size_t at = entry_size; at + entry_size <= record.size(); at += entry_size) {
    const unsigned key = number(at);
    const bool is_here = number(at + 2) == 0;
    const unsigned value = number(at + 6);
    if (!is_here) continue;
    if (key == 1024 && value == 2) system.not_plane = geographic;
    if (key == 1024 && value == 3) system.not_plane = geocentric;
    if (key == 3076) system.plan_unit = length_of_epsg(value);
    if (key == 4099) system.up_unit = length_of_epsg(value);
  }
  return system;
}

LasSystem system_of_wkt(std::string_view record) {
  LasSystem system;
  const std::string_view projected = node_of(record, {"PROJCS[", "PROJCRS["});
  if (!projected.empty()) {
    system.plan_unit = unit_of(projected);
  } else if (!node_of(record, {"GEOCCS["}).empty()) {
    system.not_plane = geocentric;
  } else if (!node_of(record, {"GEOGCS[", "GEOGCRS["}).empty()) {
    system.not_plane = geographic;
  }
  system.up_unit = unit_of(node_of(record, {"VERT_CS[", "VERTCRS["}));
  return system;
}

}  // namespace excavplan
