// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/path_library.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "library/library_cells.hpp"
#include "library/library_midway.hpp"

namespace excavplan {
namespace {

constexpr const char* format = "excavplan-path-library";
constexpr int version = 4;

using Entries = std::vector<PathLibraryEntry>;

/// The entries of one slope.
struct Row {
  Entries::const_iterator begin;
  Entries::const_iterator end;
};

Row row_of(const PathLibrary& library, double slope) {
  const auto before = [](const PathLibraryEntry& entry, double value) {
    return entry.slope < value;
  };
  const auto after = [](double value, const PathLibraryEntry& entry) {
    return value < entry.slope;
  };
  const Entries& entries = library.entries;
  return {std::lower_bound(entries.begin(), entries.end(), slope, before),
          std::upper_bound(entries.begin(), entries.end(), slope, after)};
}

/// Two places in the library and how far a value is from the first to the second.
template <typename Place>
struct Between {
  Place below;
  Place above;
  double share = 0.0;
};

[[noreturn]] void refuse(const std::string& what, double value, double lower, double upper) {
  throw Error(ErrorKind::bad_input, "library: " + what + " " + number_text(value) +
                                        " is outside its range " + number_text(lower) + " .. " +
                                        number_text(upper));
}

Between<Row> slopes_around(const PathLibrary& library, double slope) {
  const Entries& entries = library.entries;
  if (entries.empty()) throw Error(ErrorKind::bad_input, "library: it holds no entry");
  const double lowest = entries.front().slope;
  const double highest = entries.back().slope;
  if (!(slope >= lowest && slope <= highest)) refuse("slope [rad]", slope, lowest, highest);
  const Row exact = row_of(library, slope);
  if (exact.begin != exact.end) return {exact, exact, 0.0};
  const Row below = row_of(library, std::prev(exact.begin)->slope);
  const Row above = row_of(library, exact.begin->slope);
  const double from = below.begin->slope;
  for (const PathLibraryGap& gap : library.gaps) {
    if (gap.slope <= from || gap.slope >= above.begin->slope) continue;
    throw Error(ErrorKind::bad_input, "library: no dig is feasible at any density on a slope of " +
                                          number_text(gap.slope) + " rad");
  }
  return {below, above, (slope - from) / (above.begin->slope - from)};
}

void refuse_gap(const PathLibrary& library, const Row& row, double from, double to) {
  for (const PathLibraryGap& gap : library.gaps) {
    if (gap.slope == row.begin->slope && gap.density_percent > from && gap.density_percent < to) {
      throw Error(ErrorKind::bad_input, "library: no dig is feasible at a density of " +
                                            number_text(gap.density_percent) + " % on a slope of " +
                                            number_text(gap.slope) + " rad");
    }
  }
}

Between<Entries::const_iterator> densities_around(const PathLibrary& library, const Row& row,
                                                  double density) {
  const double lowest = row.begin->density_percent;
  const double highest = std::prev(row.end)->density_percent;
  if (!(density >= lowest && density <= highest)) refuse("density [%]", density, lowest, highest);
  const auto above = std::lower_bound(
      row.begin, row.end, density,
      [](const PathLibraryEntry& entry, double value) { return entry.density_percent < value; });
  if (above->density_percent == density) return {above, above, 0.0};
  const auto below = std::prev(above);
  refuse_gap(library, row, below->density_percent, above->density_percent);
  return {below, above,
          (density - below->density_percent) / (above->density_percent - below->density_percent)};
}

PlannedDig look_up(const PathLibrary& library, const Row& row, double density) {
  const auto around = densities_around(library, row, density);
  return dig_between(around.below->dig, around.above->dig, around.share, around.below->jump);
}

/// @param row  the lower one of the slopes
bool jumps_between_slopes(const PathLibrary& library, const Row& row, double density) {
  const auto around = densities_around(library, row, density);
  return (around.share < 0.5 ? around.below : around.above)->jump_slope;
}

/// Of the error midway, at a share of the way from one entry to the next.
double size_at(double share) { return 4.0 * share * (1.0 - share); }

MidwayError scaled(const MidwayError& error, double size) {
  return {size * error.loss, size * error.expectation};
}

MidwayError larger(const MidwayError& a, const MidwayError& b) {
  return {std::max(a.loss, b.loss),
          std::abs(a.expectation) > std::abs(b.expectation) ? a.expectation : b.expectation};
}

MidwayError error_between_densities(const PathLibrary& library, const Row& row, double density) {
  const auto around = densities_around(library, row, density);
  return scaled(around.below->midway, size_at(around.share));
}

/// @param row  the lower one of the slopes
MidwayError error_between_slopes(const PathLibrary& library, const Row& row, double density) {
  const auto around = densities_around(library, row, density);
  return larger(around.below->midway_slope, around.above->midway_slope);
}

/// Rises with slope and density, in this order.
template <typename Item>
bool before(const Item& a, const Item& b) {
  return a.slope != b.slope ? a.slope < b.slope : a.density_percent < b.density_percent;
}

template <typename Item>
void require_order(const JsonObject& file, const std::string& key, const std::vector<Item>& items) {
  for (std::size_t i = 1; i < items.size(); ++i) {
    if (!before(items[i - 1], items[i])) {
      file.fail(key, "slopes, and densities of a slope, must rise, entry " + std::to_string(i + 1) +
                         " does not");
    }
  }
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
  const std::string content = read_file(path);
  for (int old = 1; old < version; ++old) {
    if (content.find("\"version\": " + std::to_string(old) + ",") < 100) {
      throw Error(ErrorKind::bad_file, path + ": version: is " + std::to_string(old) +
                                           ", this program reads version " +
                                           std::to_string(version) +
                                           "; build the library again: build-path-library --out "
                                           "FILE");
    }
  }
  JsonObject file = JsonObject::open_sealed(path, content, format, version);
  PathLibrary library;
  library.machine = file.text("machine");
  library.soil = file.text("soil");
  library.machine_fingerprint = file.text("machine_fingerprint");
  library.soil_fingerprint = file.text("soil_fingerprint");
  library.simulator = file.text("simulator");
  library.cell_size = file.number("cell_m", 0.0, 1.0);
  library.seed = static_cast<std::uint64_t>(file.number("seed", 0.0, most_exact));
  library.search = file.text("search");
  for (JsonObject& object : file.objects("entries")) {
    library.entries.push_back(read_library_entry(std::move(object)));
  }
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
                                 {"evaluations", library.evaluations()}};
  file["entries"] = nlohmann::ordered_json::array();
  for (const PathLibraryEntry& entry : library.entries) {
    file["entries"].push_back(library_entry_json(entry));
  }
  file["gaps"] = nlohmann::ordered_json::array();
  for (const PathLibraryGap& gap : library.gaps) {
    file["gaps"].push_back({{"density_percent", gap.density_percent}, {"slope_rad", gap.slope}});
  }
  return sealed_text(file);
}

void require_fit(const PathLibrary& library, const Machine& machine, const SoilKind& soil,
                 const std::string& name) {
  std::string text = difference("its machine", library.machine, machine.name) +
                     difference("its soil", library.soil, soil.name) +
                     difference("its simulator", library.simulator, HeightMapSimulator::name());
  if (library.machine == machine.name && library.machine_fingerprint != fingerprint(machine)) {
    text += "; the numbers of machine " + machine.name + " have changed since it was computed";
  }
  if (library.soil == soil.name && library.soil_fingerprint != fingerprint(soil)) {
    text += "; the numbers of soil " + soil.name + " have changed since it was computed";
  }
  if (!text.empty()) {
    throw Error(ErrorKind::bad_input,
                name + ": does not fit" + text + "; build-path-library makes one that does");
  }
}

PlannedDig look_up(const PathLibrary& library, double density_percent, double slope) {
  const Between<Row> rows = slopes_around(library, slope);
  const PlannedDig below = look_up(library, rows.below, density_percent);
  if (rows.share == 0.0) return below;
  return dig_between(below, look_up(library, rows.above, density_percent), rows.share,
                     jumps_between_slopes(library, rows.below, density_percent));
}

MidwayError look_up_error(const PathLibrary& library, double density_percent, double slope) {
  const Between<Row> rows = slopes_around(library, slope);
  const MidwayError of_density =
      larger(error_between_densities(library, rows.below, density_percent),
             error_between_densities(library, rows.above, density_percent));
  if (rows.share == 0.0) return of_density;
  const MidwayError of_slope =
      scaled(error_between_slopes(library, rows.below, density_percent), size_at(rows.share));
  return {std::min(1.0, of_density.loss + of_slope.loss),
          of_density.expectation + of_slope.expectation};
}

}  // namespace excavplan
