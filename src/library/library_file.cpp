// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/path_library.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

constexpr const char* format = "excavplan-path-library";
constexpr int version = 5;

constexpr double most_evaluations = 1e9;

/// Rises with slope and density, in this order.
template <typename Item>
void require_order(const JsonObject& file, const std::string& key, const std::vector<Item>& items) {
  const auto place = [](const Item& item) { return std::pair(item.slope, item.density_percent); };
  for (std::size_t i = 1; i < items.size(); ++i) {
    if (place(items[i - 1]) < place(items[i])) continue;
    file.fail(key, "slopes, and densities of a slope, must rise, entry " + std::to_string(i + 1) +
                       " does not");
  }
}

void add(nlohmann::ordered_json& json, const std::string& to, const Interpolation& between) {
  json[to + "_loss"] = between.midway.loss;
  json[to + "_expectation_error"] = between.midway.expectation;
  json[to + "_nearest"] = between.nearest;
}

Interpolation read_interpolation(JsonObject& object, const std::string& to) {
  return {{object.number(to + "_loss", 0.0, 1.0), object.number(to + "_expectation_error", -1.0)},
          object.flag(to + "_nearest")};
}

nlohmann::ordered_json entry_json(const PathLibraryEntry& entry) {
  nlohmann::ordered_json json = {{"density_percent", entry.density_percent},
                                 {"slope_rad", entry.slope}};
  json.update(dig_json(entry.dig));
  add(json, "midway", entry.to_next_density);
  add(json, "midway_slope", entry.to_next_slope);
  json["evaluations"] = entry.evaluations;
  return json;
}

PathLibraryEntry read_entry(JsonObject& object) {
  PathLibraryEntry entry;
  entry.density_percent = object.number("density_percent", 0.0, 100.0);
  entry.slope = object.number("slope_rad", -1.0, 1.0);
  entry.dig = read_dig(object);
  entry.to_next_density = read_interpolation(object, "midway");
  entry.to_next_slope = read_interpolation(object, "midway_slope");
  entry.evaluations = static_cast<int>(object.number("evaluations", 0.0, most_evaluations));
  object.done();
  return entry;
}

}  // namespace

PathLibrary load_path_library(const std::string& path) {
  JsonObject file = JsonObject::open_sealed(path, read_file(path), format, version);
  PathLibrary library;
  library.file = path;
  library.machine = file.text("machine");
  library.soil = file.text("soil");
  library.machine_fingerprint = file.text("machine_fingerprint");
  library.soil_fingerprint = file.text("soil_fingerprint");
  library.simulator = file.text("simulator");
  library.cell_size = file.number("cell_m", 0.0, 1.0);
  library.seed = static_cast<std::uint64_t>(file.number("seed", 0.0, most_exact));
  library.search = file.text("search");
  for (JsonObject& object : file.objects("entries")) library.entries.push_back(read_entry(object));
  require_order(file, "entries", library.entries);
  if (library.entries.empty()) file.fail("entries", "holds no entry");
  for (JsonObject& object : file.objects("gaps")) {
    library.gaps.push_back(
        {object.number("density_percent", 0.0, 100.0), object.number("slope_rad", -1.0, 1.0)});
    object.done();
  }
  require_order(file, "gaps", library.gaps);
  file.ignore("evaluations");
  file.ignore("note");
  file.done();
  return library;
}

std::string file_name(const PathLibrary& library) {
  return file_name_part(library.machine) + "-" + file_name_part(library.soil) + ".json";
}

std::string to_json(const PathLibrary& library) {
  nlohmann::ordered_json file = {{"format", format},
                                 {"version", version},
                                 {"machine", library.machine},
                                 {"soil", library.soil},
                                 {"machine_fingerprint", library.machine_fingerprint},
                                 {"soil_fingerprint", library.soil_fingerprint},
                                 {"simulator", library.simulator},
                                 {"cell_m", library.cell_size},
                                 {"seed", library.seed},
                                 {"search", library.search},
                                 {"evaluations", library.evaluations()},
                                 {"entries", nlohmann::ordered_json::array()},
                                 {"gaps", nlohmann::ordered_json::array()}};
  for (const PathLibraryEntry& entry : library.entries) file["entries"] += entry_json(entry);
  for (const PathLibraryGap& gap : library.gaps) {
    file["gaps"] += {{"density_percent", gap.density_percent}, {"slope_rad", gap.slope}};
  }
  return sealed_text(file);
}

}  // namespace excavplan
