// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/path_library.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

constexpr const char* library_format = "excavplan-path-library";
constexpr int version = 6;

constexpr double most_evaluations_of_entry = 1e9;

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

/// In the order of Between.
constexpr std::array between_words = {"mix", "nearest", "lower", "upper"};

const char* word_of(Between between) { return between_words[static_cast<std::size_t>(between)]; }

Between between_of(JsonObject& object, const std::string& key) {
  const std::string word = object.text(key);
  for (std::size_t i = 0; i < between_words.size(); ++i) {
    if (word == between_words[i]) return static_cast<Between>(i);
  }
  object.fail(key, "is " + in_quotes(word) + ", must be mix, nearest, lower or upper");
}

void add(nlohmann::ordered_json& json, const std::string& to, const Interpolation& between) {
  json[to + "_loss"] = between.midway.loss;
  json[to + "_expectation_error"] = between.midway.expectation;
  json[to + "_between"] = word_of(between.between);
}

Interpolation read_interpolation(JsonObject& object, const std::string& to) {
  return {{object.number(to + "_loss", 0.0, 1.0), object.number(to + "_expectation_error", -1.0)},
          between_of(object, to + "_between")};
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
  entry.evaluations =
      static_cast<int>(object.number("evaluations", 0.0, most_evaluations_of_entry));
  object.done();
  return entry;
}

using Entries = std::vector<PathLibraryEntry>;

void require_inside(const std::string& what, double value, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  refuse("library: " + what + " " + number_text(value) + " is outside its range " +
         number_text(lower) + " .. " + number_text(upper));
}

/// The entries around a density on one slope, and how far it is from the first to the second.
struct Densities {
  Entries::const_iterator below;
  Entries::const_iterator above;
  double share = 0.0;

  Entries::const_iterator nearest() const { return share < 0.5 ? below : above; }
};

Densities densities_around(const PathLibrary& library, double slope, double density) {
  const auto begin =
      std::find_if(library.entries.begin(), library.entries.end(),
                   [&](const PathLibraryEntry& entry) { return entry.slope == slope; });
  const auto end = std::find_if(begin, library.entries.end(), [&](const PathLibraryEntry& entry) {
    return entry.slope != slope;
  });
  require_inside("density [%]", density, begin->density_percent, std::prev(end)->density_percent);
  const auto above = std::find_if(
      begin, end, [&](const PathLibraryEntry& entry) { return entry.density_percent >= density; });
  if (above->density_percent == density) return {above, above, 0.0};
  const auto below = std::prev(above);
  const double from = below->density_percent;
  const double to = above->density_percent;
  for (const PathLibraryGap& gap : library.gaps) {
    if (gap.slope != slope || gap.density_percent < from || gap.density_percent > to) continue;
    refuse("library: no dig is feasible at a density of " + number_text(gap.density_percent) +
           " % on a slope of " + number_text(slope) + " rad");
  }
  return {below, above, (density - from) / (to - from)};
}

/// The entries around a density on the slopes around a slope.
struct Around {
  Densities low;
  Densities high;
  double share = 0.0;  ///< of the way from the lower slope to the higher
};

Around around(const PathLibrary& library, double density, double slope) {
  const Entries& entries = library.entries;
  if (entries.empty()) refuse("library: it holds no entry");
  require_inside("slope [rad]", slope, entries.front().slope, entries.back().slope);
  const auto above = std::find_if(entries.begin(), entries.end(),
                                  [&](const PathLibraryEntry& e) { return e.slope >= slope; });
  const double to = above->slope;
  const double from = to == slope ? to : std::prev(above)->slope;
  for (const PathLibraryGap& gap : library.gaps) {
    if (gap.slope <= from || gap.slope >= to) continue;
    refuse("library: no dig is feasible at any density on a slope of " + number_text(gap.slope) +
           " rad");
  }
  return {densities_around(library, from, density), densities_around(library, to, density),
          from == to ? 0.0 : (slope - from) / (to - from)};
}

/// The error at a share of the way from one entry to the next. It is none at the entry whose dig is
/// used.
MidwayError scaled(const MidwayError& midway, Between between, double share) {
  const double size = share == 0.0 || share == 1.0 ? 0.0
                      : between == Between::upper  ? 2.0 * (1.0 - share)
                      : between == Between::lower  ? 2.0 * share
                                                   : 4.0 * share * (1.0 - share);
  return {size * midway.loss, size * midway.expectation};
}

MidwayError larger(const MidwayError& a, const MidwayError& b) {
  return {std::max(a.loss, b.loss),
          std::abs(a.expectation) > std::abs(b.expectation) ? a.expectation : b.expectation};
}

PlannedDig dig_at(const Densities& place) {
  return dig_between(place.below->dig, place.above->dig, place.share,
                     place.below->to_next_density.between);
}

MidwayError error_at(const Densities& place) {
  const Interpolation& next = place.below->to_next_density;
  return scaled(next.midway, next.between, place.share);
}

std::string difference(const std::string& what, const std::string& own, const std::string& asked) {
  return own == asked ? "" : "; " + what + " is " + own + ", not " + asked;
}

}  // namespace

int PathLibrary::evaluations() const {
  int sum = 0;
  for (const PathLibraryEntry& entry : entries) sum += entry.evaluations;
  return sum;
}

PathLibrary load_path_library(const std::string& path) {
  JsonObject file = JsonObject::open_sealed(path, read_file(path), library_format, version);
  PathLibrary library;
  library.file = path;
  library.machine = file.text("machine");
  library.soil = file.text("soil");
  library.machine_fingerprint = file.text("machine_fingerprint");
  library.soil_fingerprint = file.text("soil_fingerprint");
  library.simulator = file.text("simulator");
  library.cell_size = file.number("cell_m", 0.0, 1.0);
  library.seed = static_cast<std::uint64_t>(file.number("seed", 0.0, most_exact));
  library.objective = read_goal(file);
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
  return file_name_part(library.machine) + "-" + file_name_part(library.soil) + "-" +
         info_of(library.objective.goal).word + ".json";
}

std::string to_json(const PathLibrary& library) {
  nlohmann::ordered_json file = {{"format", library_format},
                                 {"version", version},
                                 {"machine", library.machine},
                                 {"soil", library.soil},
                                 {"machine_fingerprint", library.machine_fingerprint},
                                 {"soil_fingerprint", library.soil_fingerprint},
                                 {"simulator", library.simulator},
                                 {"cell_m", library.cell_size},
                                 {"seed", library.seed}};
  file.update(goal_json(library.objective));
  file.update({{"search", library.search},
               {"evaluations", library.evaluations()},
               {"entries", nlohmann::ordered_json::array()},
               {"gaps", nlohmann::ordered_json::array()}});
  for (const PathLibraryEntry& entry : library.entries) file["entries"] += entry_json(entry);
  for (const PathLibraryGap& gap : library.gaps) {
    file["gaps"] += {{"density_percent", gap.density_percent}, {"slope_rad", gap.slope}};
  }
  require_storable(file, "path library");
  return sealed_text(file);
}

void require_fit(const PathLibrary& library, const Machine& machine, const SoilKind& soil,
                 const DigObjective& objective, const std::string& simulator) {
  std::string text = difference("its machine", library.machine, machine.name) +
                     difference("its soil", library.soil, soil.name) +
                     difference("its goal", describe(library.objective), describe(objective)) +
                     difference("its simulator", library.simulator, simulator);
  if (library.machine == machine.name && library.machine_fingerprint != fingerprint(machine)) {
    text += "; the numbers of machine " + machine.name + " have changed since it was computed";
  }
  if (library.soil == soil.name && library.soil_fingerprint != fingerprint(soil)) {
    text += "; the numbers of soil " + soil.name + " have changed since it was computed";
  }
  if (!text.empty()) {
    refuse((library.file.empty() ? "the library" : library.file) + ": does not fit" + text +
           "; build-path-library makes one that does, a search needs none");
  }
}

PlannedDig look_up(const PathLibrary& library, double density_percent, double slope) {
  const Around place = around(library, density_percent, slope);
  PlannedDig dig = dig_between(dig_at(place.low), dig_at(place.high), place.share,
                               place.low.nearest()->to_next_slope.between);
  for (double PlannedDig::*figure : dig_figures) {
    require(std::isfinite(dig.*figure), "library: a figure of its dig", dig.*figure, "finite");
  }
  return dig;
}

MidwayError look_up_error(const PathLibrary& library, double density_percent, double slope) {
  const Around place = around(library, density_percent, slope);
  const MidwayError of_density = larger(error_at(place.low), error_at(place.high));
  const MidwayError of_slope =
      scaled(larger(place.low.below->to_next_slope.midway, place.low.above->to_next_slope.midway),
             place.low.nearest()->to_next_slope.between, place.share);
  return {std::min(1.0, of_density.loss + of_slope.loss),
          of_density.expectation + of_slope.expectation};
}

}  // namespace excavplan
