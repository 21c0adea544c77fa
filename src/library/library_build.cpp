// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/library_build.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include <excavplan/error.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "library/library_cells.hpp"
#include "library/library_midway.hpp"
#include "library/library_row.hpp"
#include "library/shared_tasks.hpp"

namespace excavplan {
namespace {

constexpr int most_points = 1000000;  // of a first generation; ours

void require(bool holds, const std::string& text) {
  if (!holds) throw Error(ErrorKind::bad_input, "library: " + text);
}

void require_rising(const std::string& what, const std::vector<double>& values, double lowest,
                    double highest) {
  require(!values.empty(), "no " + what + " is asked for");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool rising = i == 0 || values[i] > values[i - 1];
    require(values[i] >= lowest && values[i] <= highest && rising,
            what + " must rise inside " + number_text(lowest) + " .. " + number_text(highest) +
                ", got " + number_text(values[i]) + " at place " + std::to_string(i + 1));
  }
}

/// Libraries are told apart by the names of their machine and soil.
template <typename Named>
void require_unlike(const std::string& what, const std::vector<Named>& all) {
  std::set<std::string> names;
  for (const Named& one : all) {
    require(names.insert(file_name_part(one.name)).second,
            "two of the " + what + "s are named '" + one.name + "', or alike");
  }
}

/// Row and density of a cell.
using Key = std::pair<std::size_t, double>;

/// The cells, each for itself: what those asked for came to, computed or read from the folder.
class Cells {
 public:
  Cells(const std::vector<LibraryRow>& rows, const LibraryBuildOptions& options, SharedTasks& tasks)
      : rows_(rows), options_(options), tasks_(tasks) {
    if (options.folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    if (!std::filesystem::is_directory(options.folder)) {
      throw Error(ErrorKind::bad_file, options.folder + ": is not a folder and cannot be made");
    }
  }

  bool has(const Key& key) const { return outcomes_.count(key) == 1; }
  const CellOutcome& operator[](const Key& key) const { return outcomes_.at(key); }

  enum class Source { folder, anywhere };

  /// Reads or computes the cells, and before each those that it starts from.
  void take(const std::vector<Key>& wanted, Source source) {
    std::map<Key, std::size_t> generations;
    for (const Key& key : wanted) add_with_parents(key, generations);
    std::vector<Key> keys;
    for (const auto& [key, generation] : generations) keys.push_back(key);
    std::stable_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
      return generations.at(a) < generations.at(b);
    });
    std::map<Key, std::size_t> places;
    std::vector<std::vector<std::size_t>> parents(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      places[keys[i]] = i;
      for (const Key& parent : missing_parents(keys[i])) parents[i].push_back(places.at(parent));
    }
    tasks_.watch().expect(outcomes_.size() + keys.size());
    tasks_.run_in_order(
        parents, [&](std::size_t i) { return text_of(keys[i], source); },
        [&](std::size_t i, const std::string& text) {
          const CellOutcome outcome = read_cell("cell", text, cell_of(keys[i]), options_.search);
          const std::lock_guard<std::mutex> lock(mutex_);
          outcomes_[keys[i]] = outcome;
        });
  }

 private:
  /// @return the generation of a cell that is missing: 0 if it need not wait for another one
  std::size_t add_with_parents(const Key& key, std::map<Key, std::size_t>& generations) const {
    if (outcomes_.count(key) == 1) return 0;
    std::size_t own = 0;
    for (const Key& parent : missing_parents(key)) {
      own = std::max(own, 1 + add_with_parents(parent, generations));
    }
    return generations[key] = own;
  }

  std::vector<Key> missing_parents(const Key& key) const {
    std::vector<Key> parents;
    for (const double density : parent_densities(key.second, options_.search)) {
      const Key parent{key.first, density};
      if (outcomes_.count(parent) == 0) parents.push_back(parent);
    }
    return parents;
  }

  /// The text of a cell's file, from the folder or computed; empty if stopped.
  std::string text_of(const Key& key, Source source) {
    const LibraryCell cell = cell_of(key);
    const std::string name = cell_file_name(cell, options_.search);
    if (const std::string kept = kept_text(cell, name, source); !kept.empty()) {
      tasks_.watch().cell_done(false);
      return kept;
    }
    if (source == Source::folder) {
      throw Error(ErrorKind::bad_file, options_.folder + "/" + name +
                                           ": is missing: the shard that computes it has not "
                                           "ended, or machine, soil or program have changed since");
    }
    const auto outcome =
        compute_cell(cell, options_.search, parents_of(key), tasks_.watch().of(name));
    if (!outcome) return {};
    const std::string text = cell_text(cell, options_.search, *outcome);
    if (!options_.folder.empty()) write_file(options_.folder + "/" + name, text);
    tasks_.watch().cell_done(true);
    return text;
  }

  std::vector<CellOutcome> parents_of(const Key& key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<CellOutcome> parents;
    for (const double density : parent_densities(key.second, options_.search)) {
      parents.push_back(outcomes_.at({key.first, density}));
    }
    return parents;
  }

  std::string kept_text(const LibraryCell& cell, const std::string& name, Source source) const {
    const std::string path = options_.folder + "/" + name;
    if (options_.folder.empty() || !std::filesystem::exists(path)) return {};
    try {
      const std::string text = read_file(path);
      read_cell(path, text, cell, options_.search);
      return text;
    } catch (const Error& e) {
      if (source == Source::folder) throw;
      tasks_.watch().note(std::string(e.what()) + "; it is computed anew");
      return {};
    }
  }

  LibraryCell cell_of(const Key& key) const { return rows_[key.first].cell(key.second); }

  const std::vector<LibraryRow>& rows_;
  const LibraryBuildOptions& options_;
  SharedTasks& tasks_;
  std::mutex mutex_;  // guards the outcomes while cells are computed
  std::map<Key, CellOutcome> outcomes_;
};

class Build {
 public:
  Build(const LibraryGrid& grid, const LibraryBuildOptions& options)
      : grid_(grid),
        options_(options),
        tasks_(options),
        rows_(rows_of(grid)),
        cells_(rows_, options, tasks_) {}

  LibraryBuild whole() {
    Source source = options_.only_merge ? Source::folder : Source::anywhere;
    do {
      cells_.take(all_keys(), source);
      source = Source::anywhere;  // densities that are added belong to no shard
      if (!tasks_.stopped()) settle_rows();
    } while (!tasks_.stopped() && refine());
    std::vector<PathLibrary> libraries;
    for (std::size_t first = 0; first < rows_.size() && !tasks_.stopped();
         first += grid_.slopes.size()) {
      libraries.push_back(library_of(first));
      measure_slopes(libraries.back(), first);
    }
    LibraryBuild build = summary(all_keys());
    if (!build.stopped) build.libraries = std::move(libraries);
    return build;
  }

  LibraryBuild part(const LibraryShard& shard) {
    require(!options_.folder.empty(), "a shard needs a folder for its cells");
    require(shard.count >= 1 && shard.index >= 1 && shard.index <= shard.count,
            "shard " + std::to_string(shard.index) + "/" + std::to_string(shard.count) +
                " must be 1/N .. N/N");
    const std::vector<Key> all = all_keys();
    const auto cut = [&](int i) {
      return static_cast<std::ptrdiff_t>(all.size() * static_cast<std::size_t>(i) /
                                         static_cast<std::size_t>(shard.count));
    };
    // Neighbours stay together: only at its two ends a part computes a parent that others have too.
    const std::vector<Key> mine(all.begin() + cut(shard.index - 1), all.begin() + cut(shard.index));
    cells_.take(mine, Source::anywhere);
    return summary(mine);
  }

 private:
  using Source = Cells::Source;

  static std::vector<LibraryRow> rows_of(const LibraryGrid& grid) {
    std::vector<LibraryRow> rows;
    for (const Machine& machine : grid.machines) {
      for (const SoilKind& soil : grid.soils) {
        for (const double slope : grid.slopes) {
          rows.emplace_back(LibraryCell{&machine, &soil, slope, 0.0}, grid.densities_percent);
        }
      }
    }
    return rows;
  }

  std::vector<Key> all_keys() const {
    std::vector<Key> keys;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      for (const double density : rows_[row].densities()) keys.push_back({row, density});
    }
    return keys;
  }

  LibraryBuild summary(const std::vector<Key>& wanted) const {
    LibraryBuild build;
    build.stopped = tasks_.stopped();
    build.cells = wanted.size();
    build.cells_done = static_cast<std::size_t>(std::count_if(
        wanted.begin(), wanted.end(), [&](const Key& key) { return cells_.has(key); }));
    return build;
  }

  /// Measures between all densities, and looks again at those whose neighbours know better, until
  /// there is nothing left to do.
  void settle_rows() {
    for (const Key& key : all_keys()) rows_[key.first].take(key.second, cells_[key]);
    do {
      measure_midways();
    } while (!tasks_.stopped() && look_again());
  }

  void measure_midways() {
    std::vector<std::pair<LibraryRow*, LibraryRow::Pair>> all;
    for (LibraryRow& row : rows_) {
      for (const LibraryRow::Pair& pair : row.unmeasured()) all.push_back({&row, pair});
    }
    tasks_.run(
        all.size(),
        [&](std::size_t i) {
          return text_of(all[i].first->measure(all[i].second, options_.search.cell_size));
        },
        [&](std::size_t i, const std::string& text) {
          all[i].first->take(all[i].second, midway_in(text));
        });
  }

  /// @return false if there was nothing to look at
  bool look_again() {
    std::vector<std::pair<LibraryRow*, LibraryRow::Look>> all;
    if (std::holds_alternative<GeneticAlgorithm>(options_.search.method)) return false;
    for (LibraryRow& row : rows_) {
      for (const LibraryRow::Look& look : row.looks_due()) all.push_back({&row, look});
    }
    tasks_.run(
        all.size(),
        [&](std::size_t i) {
          const auto& [row, look] = all[i];
          const LibraryCell cell = row->cell(look.density);
          const auto outcome =
              excavplan::look_again(cell, options_.search, row->starts_of(look),
                                    tasks_.watch().of(cell_file_name(cell, options_.search)));
          return outcome ? cell_text(cell, options_.search, *outcome) : std::string();
        },
        [&](std::size_t i, const std::string& text) {
          const auto& [row, look] = all[i];
          row->take(look, read_cell("second look", text, row->cell(look.density), options_.search));
        });
    return !all.empty();
  }

  static std::string text_of(const Midway& midway) {
    return nlohmann::json{midway.error.loss, midway.error.expectation, midway.evaluations,
                          midway.better, midway.jump}
        .dump();
  }
  static Midway midway_in(const std::string& text) {
    const auto json = nlohmann::json::parse(text);
    return {{json[0].get<double>(), json[1].get<double>()},
            json[2].get<int>(),
            json[3].get<Midway::Better>(),
            json[4].get<bool>()};
  }

  /// @return true if densities were added
  bool refine() {
    if (options_.refine == 0.0) return false;
    bool any = false;
    for (LibraryRow& row : rows_) any = row.refine(options_.refine) || any;
    return any;
  }

  PathLibrary library_of(std::size_t first) const {
    const LibraryCell any = rows_[first].cell(0.0);
    PathLibrary library{any.machine->name,
                        any.soil->name,
                        fingerprint(*any.machine),
                        fingerprint(*any.soil),
                        HeightMapSimulator::name(),
                        options_.search.cell_size,
                        options_.search.seed,
                        describe(options_.search),
                        {},
                        {}};
    for (std::size_t r = first; r < first + grid_.slopes.size(); ++r) rows_[r].add_to(library);
    if (library.entries.empty()) {
      throw Error(ErrorKind::bad_input, "library: no dig is feasible for " + library.machine +
                                            " in " + library.soil + " at any density");
    }
    return library;
  }

  /// Digs what is looked up midway between two slopes.
  void measure_slopes(PathLibrary& library, std::size_t first) {
    const std::vector<SlopeGap> gaps = slope_gaps(library);
    tasks_.run(
        gaps.size(),
        [&](std::size_t i) {
          const SlopeGap& gap = gaps[i];
          LibraryCell midway = rows_[first].cell(gap.density_percent);
          midway.slope = gap.middle;
          return text_of(measure_midway(midway, options_.search.cell_size, gap.below, gap.above,
                                        gap.best_expected));
        },
        [&](std::size_t i, const std::string& text) {
          PathLibraryEntry& entry = library.entries[gaps[i].entry];
          const Midway midway = midway_in(text);
          entry.midway_slope = midway.error;
          entry.jump_slope = midway.jump;
          entry.evaluations += midway.evaluations;
        });
  }

  const LibraryGrid& grid_;
  const LibraryBuildOptions& options_;
  SharedTasks tasks_;
  std::vector<LibraryRow> rows_;  // slopes of a machine and soil stand together
  Cells cells_;
};

}  // namespace

void require_buildable(const LibraryGrid& grid, const LibraryBuildOptions& options) {
  require(!grid.machines.empty(), "no machine is asked for");
  require(!grid.soils.empty(), "no soil is asked for");
  require_rising("densities [%]", grid.densities_percent, 0.0, 100.0);
  require_rising("slopes [rad]", grid.slopes, -1.0, 1.0);
  require(options.refine >= 0.0 && options.refine < 1.0,
          "refine must be in 0 .. 1, got " + number_text(options.refine));
  require_unlike("machine", grid.machines);
  require_unlike("soil", grid.soils);
  require(options.search.seed <= most_exact,
          "the seed must be at most " + std::to_string(most_exact) + ", the largest whole number " +
              "that the file keeps, got " + std::to_string(options.search.seed));
  const auto* anchored = std::get_if<AnchoredSearch>(&options.search.method);
  require(!anchored || anchored->points <= most_points,
          "points must be <= " + std::to_string(most_points) + ", got " +
              std::to_string(anchored ? anchored->points : 0));
  require(options.search.cell_size >= finest_cell && options.search.cell_size <= coarsest_cell,
          "the cell of the ground must be in " + number_text(finest_cell) + " .. " +
              number_text(coarsest_cell) + " m, got " + number_text(options.search.cell_size));
  require(!options.only_merge || !options.folder.empty(), "a merge needs a folder of cells");
}

LibraryBuild build_path_libraries(const LibraryGrid& grid, const LibraryBuildOptions& options) {
  require_buildable(grid, options);
  return Build(grid, options).whole();
}

LibraryBuild build_library_shard(const LibraryGrid& grid, const LibraryShard& shard,
                                 const LibraryBuildOptions& options) {
  require_buildable(grid, options);
  return Build(grid, options).part(shard);
}

}  // namespace excavplan
