// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/maps.hpp"

#include <algorithm>
#include <filesystem>

#include "frame/named_file.hpp"
#include "frame/tool.hpp"

namespace excavplan::tools {
namespace {

const MapName& map_of(const std::string& text, const std::vector<MapName>& names) {
  const NamedFile words = named_file(text);
  if (words.file.empty()) usage_error("--map: " + text + " names no file");
  if (text.front() == '=') usage_error("--map: " + text + " has an empty name before its '='");
  if (words.name.empty()) return names.front();
  std::string all;
  for (const MapName& each : names) {
    all += (all.empty() ? "" : ", ") + each.name;
    if (each.name != words.name) continue;
    if (!each.possible.holds || each.possible.holds()) return each;
    usage_error("--map: no map '" + each.name + "': " + each.possible.otherwise);
  }
  usage_error("--map: there is no map '" + words.name + "', expected one of " + all);
}

void require_format(const std::string& file, const MapName& map) {
  try {
    if (map.layers == 0) {
      require_line_format(file);
    } else {
      require_map_format(file, map.layers);
    }
  } catch (const Error& error) {
    usage_error("--map " + map.name + ": " + error.what());
  }
}

std::string help_of(const std::vector<MapName>& names) {
  std::string help =
      "write a map for CloudCompare, QGIS or MeshLab into this file: GeoTIFF, PLY, or one layer as "
      "ASCII grid; NAME:";
  for (const MapName& each : names) {
    help += (help.back() == ':' ? " " : "; ") + each.name;
    if (!each.help.empty()) help += ", " + each.help;
    if (&each == &names.front()) help += " (default)";
  }
  return help + ". May be given several times";
}

std::string words_of(const std::vector<MapName>& names) {
  std::string words;
  for (const MapName& each : names) words += (words.empty() ? "" : "|") + each.name;
  return words;
}

void write(const std::string& file, const NamedMap& map) {
  if (map.lines.empty()) {
    write_map(file, map.map);
  } else {
    write_lines(file, map.lines);
  }
}

}  // namespace

void declare_maps(Arguments& arguments, Maps& maps, const std::vector<MapName>& names) {
  Arguments::Entry entry;
  entry.name = "map";
  entry.placeholder = "[" + words_of(names) + "=]FILE.tif|ply|asc";
  entry.help = help_of(names);
  entry.output = true;
  entry.repeated = true;
  entry.file_in = [](const std::string& text) { return named_file(text).file; };
  entry.assign = [](const std::string&) {};
  entry.check = [&maps, names](const std::string& text) {
    const MapName& map = map_of(text, names);
    const std::string file = named_file(text).file;
    require_format(file, map);
    maps.files.push_back({map.name, file});
  };
  arguments.add(entry);
}

void write_maps(const Maps& maps, const std::function<std::vector<NamedMap>()>& contents,
                Outcome& outcome) {
  if (maps.files.empty()) return;
  const std::vector<NamedMap> all = contents();
  for (const Maps::File& each : maps.files) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const NamedMap& map) { return map.name == each.map; });
    if (found != all.end()) {
      write(each.file, *found);
      continue;
    }
    std::error_code unknown;
    if (!std::filesystem::exists(each.file, unknown)) continue;
    outcome.warnings.emplace_back(WarningCode::map_not_written,
                                  each.file + ": is of an earlier run, as there is no dig to show");
  }
}

std::vector<MapName> ground_map_names(std::size_t layers) {
  return {{"all", "all of these layers, not as .asc", layers},
          {"before", "height of the ground before"},
          {"after", "height after"},
          {"change", "height after less before"}};
}

}  // namespace excavplan::tools
