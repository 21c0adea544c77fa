// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "library/library_cells.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <tuple>

#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "library/library_midway.hpp"
#include "machine/dig_path_text.hpp"
#include "optimisation/search_checkpoint.hpp"

namespace excavplan {
namespace {

constexpr const char* format = "excavplan-library-cell";

// Searched from nothing, and how far apart densities are that start from one another [%]; ours,
// after docs/methods.md#library.
constexpr double anchors[] = {0.0, 50.0, 100.0};
constexpr double stride = 10.0;

double nearest_anchor(double density) {
  return *std::min_element(std::begin(anchors), std::end(anchors), [density](double a, double b) {
    return std::abs(a - density) < std::abs(b - density);
  });
}

std::string describe(const AnchoredSearch& method) {
  return "anchors: " + std::to_string(method.points) + " points, " + std::to_string(method.basins) +
         " basins, polish of " + std::to_string(method.polish_evaluations) +
         "; others: " + std::to_string(method.inherited_evaluations) + " from neighbours";
}

/// From nothing.
/// @param effort  number of times as many points as usual
DigSearchOptions cold_search(const LibrarySearch& search, int effort) {
  DigSearchOptions options;
  if (const auto* genetic = std::get_if<GeneticAlgorithm>(&search.method)) {
    options.method = *genetic;
  } else {
    const auto& anchored = std::get<AnchoredSearch>(search.method);
    MemeticSearch method;
    method.first_generation = effort * anchored.points;
    method.basins = anchored.basins;
    method.polish_evaluations = anchored.polish_evaluations;
    method.generations = 0;
    options.method = method;
  }
  return options;
}

/// What the parents of a density let expect of it.
struct Expectation {
  /// Where the line through two parents leads, or the farther one if they are of different kinds;
  /// the nearest one last.
  std::vector<DigParameters> starts;
  double efficiency = 0.0;  ///< the least to be satisfied with [kg/J]; 0 with less than two parents
};

Expectation expected_of(double density, const std::vector<CellOutcome>& parents) {
  std::vector<const PathLibraryEntry*> digs;
  for (const CellOutcome& parent : parents) {
    if (parent.entry) digs.push_back(&*parent.entry);
  }
  Expectation expected;
  if (digs.empty()) return expected;
  const PlannedDig& near = digs[0]->dig;
  if (digs.size() == 2 && far_apart(near, digs[1]->dig)) {
    expected.starts.push_back(digs[1]->dig.parameters);
  } else if (digs.size() == 2) {
    const PlannedDig& far = digs[1]->dig;
    const double share = (density - digs[0]->density_percent) /
                         (digs[1]->density_percent - digs[0]->density_percent);
    const auto line = [share](double a, double b) { return a + share * (b - a); };
    DigParameters there;
    for (const DigParameterInfo& info : dig_parameter_table()) {
      there.*info.field = std::clamp(line(near.parameters.*info.field, far.parameters.*info.field),
                                     info.lower, info.upper);
    }
    expected.starts.push_back(there);
    // The logarithm of the efficiency bends little: less than this between and beyond two; ours.
    const double slack = share > 0.0 ? 0.006 : 0.025;
    expected.efficiency =
        (1.0 - slack) * std::exp(line(std::log(near.efficiency()), std::log(far.efficiency())));
  }
  expected.starts.push_back(near.parameters);
  return expected;
}

/// A polish, and one more from its best with the simplex spread again.
DigSearchOptions warm_search(const LibrarySearch& search,
                             const std::vector<DigParameters>& starts) {
  const auto& anchored = std::get<AnchoredSearch>(search.method);
  MemeticSearch method;
  method.first_generation = 0;
  method.generations = 0;
  method.basins = 1;
  method.polish_evaluations = anchored.inherited_evaluations / 2;
  DigSearchOptions options;
  options.method = method;
  options.start = starts;
  options.stop.evaluations = anchored.inherited_evaluations;
  return options;
}

/// Starts that ask less of the machine.
std::vector<DigParameters> shallower(const DigParameters& start) {
  std::vector<DigParameters> starts;
  for (const double share : {0.85, 0.7}) {
    starts.push_back(start);
    starts.back().penetration_length *= share;
  }
  return starts;
}

/// The searches for one cell, the best of them kept.
class CellSearch {
 public:
  CellSearch(const LibraryCell& cell, const LibrarySearch& search,
             const std::function<bool(const SearchProgress&)>& progress)
      : cell_(cell),
        search_(search),
        progress_(progress),
        simulator_(*cell.machine, *cell.soil, cell.density_percent),
        ground_(sloped_planning_ground(*cell.machine, cell.slope, search.cell_size)) {}

  /// Does nothing once stopped.
  void attempt(DigSearchOptions options) {
    if (stopped_) return;
    int evaluations = 0;
    options.seed = checksum(identity(cell_, search_));
    options.threads = 1;
    options.progress = [&](const SearchProgress& now) {
      evaluations = now.evaluations;
      SearchProgress whole = now;
      whole.evaluations += outcome_.evaluations;
      stopped_ = progress_ && !progress_(whole);
      return !stopped_;
    };
    const auto found = search_dig(*cell_.machine, simulator_, ground_, options);
    outcome_.evaluations += evaluations;
    auto& best = outcome_.entry;
    if (found && (!best || found->dig.efficiency() > best->dig.efficiency())) {
      best = {cell_.density_percent, found->dig, 0, cell_.slope, {}, {}};
    }
  }

  const std::optional<PathLibraryEntry>& found() const { return outcome_.entry; }

  /// Nothing if stopped.
  std::optional<CellOutcome> outcome() const {
    if (stopped_) return std::nullopt;
    CellOutcome whole = outcome_;
    if (whole.entry) whole.entry->evaluations = whole.evaluations;
    return whole;
  }

 private:
  const LibraryCell& cell_;
  const LibrarySearch& search_;
  const std::function<bool(const SearchProgress&)>& progress_;
  const HeightMapSimulator simulator_;
  const Terrain ground_;
  CellOutcome outcome_;
  bool stopped_ = false;
};

}  // namespace

std::string file_name_part(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '+';
    text += good ? c : '_';
  }
  return text.substr(0, 60);
}

std::vector<double> parent_densities(double density_percent, const LibrarySearch& search) {
  if (std::holds_alternative<GeneticAlgorithm>(search.method)) return {};
  const double below = stride * std::floor(density_percent / stride);
  if (below < density_percent) {
    const double above = below + stride;
    if (density_percent - below < above - density_percent) return {below, above};
    return {above, below};
  }
  const double anchor = nearest_anchor(density_percent);
  if (density_percent == anchor) return {};
  const double towards = density_percent < anchor ? stride : -stride;
  if (density_percent + towards == anchor) return {anchor};
  return {density_percent + towards, density_percent + 2.0 * towards};
}

std::string describe(const LibrarySearch& search) {
  return std::visit([](const auto& method) { return describe(method); }, search.method);
}

std::string identity(const LibraryCell& cell, const LibrarySearch& search) {
  return "machine " + fingerprint(*cell.machine) + ", soil " + fingerprint(*cell.soil) +
         ", simulator " + HeightMapSimulator::name() + " on cells of " +
         number_text(search.cell_size) + " m, slope " + number_text(cell.slope) + " rad, density " +
         number_text(cell.density_percent) + " %, seed " + std::to_string(search.seed) + ", " +
         describe(search) + ", start " + describe(DigSearchOptions{}.start_rule);
}

std::string cell_file_name(const LibraryCell& cell, const LibrarySearch& search) {
  return file_name_part(cell.machine->name) + "-" + file_name_part(cell.soil->name) + "-slope" +
         number_text(cell.slope) + "-density" + number_text(cell.density_percent) + "-" +
         checksum_text(identity(cell, search)) + ".json";
}

std::optional<CellOutcome> compute_cell(
    const LibraryCell& cell, const LibrarySearch& search, const std::vector<CellOutcome>& parents,
    const std::function<bool(const SearchProgress&)>& progress) {
  CellSearch work(cell, search, progress);
  const Expectation expected = expected_of(cell.density_percent, parents);
  if (!expected.starts.empty()) work.attempt(warm_search(search, expected.starts));
  if (!work.found() && !expected.starts.empty()) {
    work.attempt(warm_search(search, shallower(expected.starts.back())));
  }
  if (!work.found() || work.found()->dig.efficiency() < expected.efficiency) {
    work.attempt(cold_search(search, 1));
  }
  if (!work.found()) work.attempt(cold_search(search, 8));
  return work.outcome();
}

std::optional<CellOutcome> look_again(const LibraryCell& cell, const LibrarySearch& search,
                                      const std::vector<CellOutcome>& neighbours,
                                      const std::function<bool(const SearchProgress&)>& progress) {
  CellSearch work(cell, search, progress);
  work.attempt(warm_search(search, expected_of(cell.density_percent, neighbours).starts));
  return work.outcome();
}

std::string cell_text(const LibraryCell& cell, const LibrarySearch& search,
                      const CellOutcome& outcome) {
  nlohmann::ordered_json json = {{"format", format},
                                 {"version", 1},
                                 {"identity", identity(cell, search)},
                                 {"evaluations", outcome.evaluations},
                                 {"feasible", outcome.entry.has_value()}};
  if (outcome.entry) json["entry"] = library_entry_json(*outcome.entry);
  return sealed_text(json);
}

CellOutcome read_cell(const std::string& name, const std::string& text, const LibraryCell& cell,
                      const LibrarySearch& search) {
  JsonObject file = JsonObject::open_sealed(name, text, format);
  if (const std::string own = file.text("identity"); own != identity(cell, search)) {
    file.fail("identity",
              "is '" + own + "', which is another cell than '" + identity(cell, search) + "'");
  }
  CellOutcome outcome;
  outcome.evaluations = static_cast<int>(file.number("evaluations", 0.0, 1e9));
  if (file.flag("feasible")) outcome.entry = read_library_entry(file.object("entry"));
  file.done();
  return outcome;
}

nlohmann::ordered_json library_entry_json(const PathLibraryEntry& entry) {
  return {{"density_percent", entry.density_percent},
          {"slope_rad", entry.slope},
          {"path", path_json(entry.dig.parameters, entry.dig.start_x)},
          {"payload_mass_kg", entry.dig.payload_mass},
          {"payload_volume_m3", entry.dig.payload_volume},
          {"energy_kj", entry.dig.energy / 1000.0},
          {"efficiency_kg_per_kj", 1000.0 * entry.dig.efficiency()},
          {"duration_s", entry.dig.duration},
          {"midway_loss", entry.midway.loss},
          {"midway_expectation_error", entry.midway.expectation},
          {"midway_slope_loss", entry.midway_slope.loss},
          {"midway_slope_expectation_error", entry.midway_slope.expectation},
          {"jump", entry.jump},
          {"jump_slope", entry.jump_slope},
          {"evaluations", entry.evaluations}};
}

PathLibraryEntry read_library_entry(JsonObject object) {
  PathLibraryEntry entry;
  entry.density_percent = object.number("density_percent", 0.0, 100.0);
  entry.slope = object.number("slope_rad", -1.0, 1.0);
  std::tie(entry.dig.parameters, entry.dig.start_x) = read_path(object.object("path"));
  entry.dig.payload_mass = object.number("payload_mass_kg", 0.0);
  entry.dig.payload_volume = object.number("payload_volume_m3", 0.0);
  entry.dig.energy = 1000.0 * object.number("energy_kj", 0.0);
  entry.dig.duration = object.number("duration_s", 0.0);
  entry.midway.loss = object.number("midway_loss", 0.0, 1.0);
  entry.midway.expectation = object.number("midway_expectation_error", -1.0);
  entry.midway_slope.loss = object.number("midway_slope_loss", 0.0, 1.0);
  entry.midway_slope.expectation = object.number("midway_slope_expectation_error", -1.0);
  entry.jump = object.flag("jump");
  entry.jump_slope = object.flag("jump_slope");
  entry.evaluations = static_cast<int>(object.number("evaluations", 0.0, 1e9));
  object.ignore("efficiency_kg_per_kj");
  object.done();
  return entry;
}

}  // namespace excavplan
