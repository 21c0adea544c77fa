// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/path_library.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "../json_file.hpp"

namespace excavplan {
namespace {

constexpr const char* format = "excavplan-path-library";

PathLibraryEntry read_entry(JsonObject object) {
  PathLibraryEntry entry;
  entry.density_percent = object.number("density_percent", 0.0, 100.0);
  JsonObject path = object.object("path");
  for (const DigParameterInfo& info : dig_parameter_table()) {
    entry.dig.parameters.*info.field = path.number(info.name, info.lower, info.upper);
  }
  entry.dig.start_x = path.number("start_x_m");
  path.done();
  entry.dig.payload_mass = object.number("payload_mass_kg", 0.0);
  entry.dig.payload_volume = object.number("payload_volume_m3", 0.0);
  entry.dig.energy = 1000.0 * object.number("energy_kj", 0.0);
  entry.dig.duration = object.number("duration_s", 0.0);
  entry.evaluations = static_cast<int>(object.number("evaluations", 0.0, 1e9));
  object.ignore("efficiency_kg_per_kj");
  object.done();
  return entry;
}

/// True if the two digs are of different kinds: a blend of them would be neither.
bool far_apart(const PlannedDig& a, const PlannedDig& b) {
  constexpr double near = 0.2;  // of a number's search range; ours
  for (const DigParameterInfo& info : dig_parameter_table()) {
    const double step = std::abs(a.parameters.*info.field - b.parameters.*info.field);
    if (step > near * (info.upper - info.lower)) return true;
  }
  return false;
}

PlannedDig blend(const PlannedDig& a, const PlannedDig& b, double share) {
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  PlannedDig dig;
  for (const DigParameterInfo& info : dig_parameter_table()) {
    dig.parameters.*info.field = mix(a.parameters.*info.field, b.parameters.*info.field);
  }
  dig.start_x = mix(a.start_x, b.start_x);
  dig.payload_mass = mix(a.payload_mass, b.payload_mass);
  dig.payload_volume = mix(a.payload_volume, b.payload_volume);
  dig.energy = mix(a.energy, b.energy);
  dig.duration = mix(a.duration, b.duration);
  return dig;
}

void check(const std::vector<double>& densities) {
  if (densities.empty()) throw Error(ErrorKind::bad_input, "library: no density is asked for");
  for (std::size_t i = 0; i < densities.size(); ++i) {
    const bool rising = i == 0 || densities[i] > densities[i - 1];
    if (!(densities[i] >= 0.0 && densities[i] <= 100.0 && rising)) {
      throw Error(ErrorKind::bad_input, "library: densities must rise inside 0 .. 100 %, got " +
                                            number_text(densities[i]) + " at place " +
                                            std::to_string(i + 1));
    }
  }
}

}  // namespace

int PathLibrary::evaluations() const {
  int sum = 0;
  for (const PathLibraryEntry& entry : entries) sum += entry.evaluations;
  return sum;
}

PathLibrary load_path_library(const std::string& path) {
  JsonObject file = JsonObject::open(path, format);
  PathLibrary library;
  library.machine = file.text("machine");
  library.soil = file.text("soil");
  library.cell = file.number("cell_m", 0.0, 1.0);
  library.seed = static_cast<std::uint64_t>(file.number("seed", 0.0, 9007199254740992.0));
  JsonObject search = file.object("search");
  library.population = static_cast<int>(search.number("population", 2.0, 1e9));
  library.generations = static_cast<int>(search.number("generations", 1.0, 1e9));
  library.polish_evaluations = static_cast<int>(search.number("polish_evaluations", 0.0, 1e9));
  search.done();
  for (JsonObject& object : file.objects("entries")) {
    library.entries.push_back(read_entry(std::move(object)));
    const std::size_t n = library.entries.size();
    if (n > 1 && library.entries[n - 1].density_percent <= library.entries[n - 2].density_percent) {
      file.fail("entries", "densities must rise, entry " + std::to_string(n) + " does not");
    }
  }
  if (library.entries.empty()) file.fail("entries", "holds no entry");
  file.ignore("evaluations");
  file.ignore("note");
  file.done();
  return library;
}

std::string to_json(const PathLibrary& library) {
  nlohmann::ordered_json file = {{"format", format},
                                 {"version", 1},
                                 {"machine", library.machine},
                                 {"soil", library.soil},
                                 {"cell_m", library.cell},
                                 {"seed", library.seed},
                                 {"search",
                                  {{"population", library.population},
                                   {"generations", library.generations},
                                   {"polish_evaluations", library.polish_evaluations}}},
                                 {"evaluations", library.evaluations()}};
  for (const PathLibraryEntry& entry : library.entries) {
    nlohmann::ordered_json path;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      path[info.name] = entry.dig.parameters.*info.field;
    }
    path["start_x_m"] = entry.dig.start_x;
    file["entries"].push_back({{"density_percent", entry.density_percent},
                               {"path", path},
                               {"payload_mass_kg", entry.dig.payload_mass},
                               {"payload_volume_m3", entry.dig.payload_volume},
                               {"energy_kj", entry.dig.energy / 1000.0},
                               {"efficiency_kg_per_kj", 1000.0 * entry.dig.efficiency()},
                               {"duration_s", entry.dig.duration},
                               {"evaluations", entry.evaluations}});
  }
  return file.dump(1) + "\n";
}

PlannedDig look_up(const PathLibrary& library, double density_percent) {
  const std::vector<PathLibraryEntry>& entries = library.entries;
  if (entries.empty() || !(density_percent >= entries.front().density_percent &&
                           density_percent <= entries.back().density_percent)) {
    throw Error(ErrorKind::bad_input,
                "library: density " + number_text(density_percent) + " % is outside its range" +
                    (entries.empty() ? std::string(" (it is empty)")
                                     : " " + number_text(entries.front().density_percent) + " .. " +
                                           number_text(entries.back().density_percent) + " %"));
  }
  const auto above = std::lower_bound(entries.begin(), entries.end(), density_percent,
                                      [](const PathLibraryEntry& entry, double density) {
                                        return entry.density_percent < density;
                                      });
  if (above->density_percent == density_percent) return above->dig;
  const auto below = above - 1;
  const double share = (density_percent - below->density_percent) /
                       (above->density_percent - below->density_percent);
  if (far_apart(below->dig, above->dig)) return share < 0.5 ? below->dig : above->dig;
  return blend(below->dig, above->dig, share);
}

PathLibrary build_path_library(const Machine& machine, const SoilKind& soil,
                               const std::vector<double>& densities_percent,
                               const LibraryBuildOptions& options) {
  check(densities_percent);
  PathLibrary library{machine.name, soil.name, options.cell, options.search.seed, 0, 0, 0, {}};
  if (const auto* genetic = std::get_if<GeneticAlgorithm>(&options.search.method)) {
    library.population = genetic->population;
    library.generations = genetic->generations;
  }
  const Terrain ground = level_planning_ground(machine, options.cell);
  for (const double density : densities_percent) {
    const auto done = std::find_if(
        options.done.begin(), options.done.end(),
        [density](const PathLibraryEntry& entry) { return entry.density_percent == density; });
    if (done != options.done.end()) {
      library.entries.push_back(*done);
      continue;
    }
    DigSearchOptions search = options.search;
    if (!library.entries.empty()) search.start = {library.entries.back().dig.parameters};
    const HeightMapSimulator simulator(machine, soil, density);
    const auto found = search_dig(machine, simulator, ground, search);
    if (!found) {
      throw Error(ErrorKind::bad_input,
                  "library: no dig is feasible at a density of " + number_text(density) + " %");
    }
    if (found->stopped) break;
    library.entries.push_back({density, found->dig, found->evaluations});
    if (options.progress && !options.progress(library.entries.size(), densities_percent.size(),
                                              library.entries.back())) {
      break;
    }
  }
  return library;
}

}  // namespace excavplan
