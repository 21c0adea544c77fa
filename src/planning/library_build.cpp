// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/library_build.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <set>

#include <excavplan/error.hpp>

#include "../json_file.hpp"
#include "../parallel.hpp"
#include "fingerprint.hpp"
#include "library_cells.hpp"

namespace excavplan {
namespace {

// Distances between two densities [%]; ours. Where entries are farther apart, what is best amid
// them cannot be told from them.
constexpr double coarsest = 10.0;
constexpr double finest = 1.0;

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

/// The only process there is.
class Alone : public WorkSharing {
 public:
  std::size_t next() override { return next_++; }
  std::vector<std::string> exchange(const std::string& mine) override {
    next_ = 0;
    return {mine};
  }

 private:
  std::atomic<std::size_t> next_{0};
};

/// What the user sees of a build, and whether he stopped it.
class Watch {
 public:
  explicit Watch(const LibraryBuildOptions& options) : callback_(options.progress) {}

  bool stopped() const { return stopped_; }
  void expect(std::size_t cells) {
    const std::lock_guard<std::mutex> lock(mutex_);
    now_.cells = cells;
  }
  void cell_done(bool computed) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++now_.cells_done;
    computed_ += computed ? 1 : 0;
    tell();
  }
  bool dig_done(const std::string& cell, double best) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++now_.evaluations;
    now_.cell = cell;
    now_.best = best;
    tell();
    return !stopped_;
  }

 private:
  void tell() {
    if (!callback_ || stopped_) return;
    now_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const auto left = static_cast<double>(now_.cells - std::min(now_.cells, now_.cells_done));
    now_.seconds_left = computed_ > 0 ? now_.seconds * left / static_cast<double>(computed_)
                                      : std::numeric_limits<double>::quiet_NaN();
    if (!callback_(now_)) stopped_ = true;
  }

  const std::function<bool(const LibraryProgress&)>& callback_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  LibraryProgress now_;
  std::size_t computed_ = 0;
  std::atomic<bool> stopped_{false};
};

/// Results by task of one process, on their way to the others.
struct Parcel {
  std::map<std::size_t, std::string> results;
  std::string error;
  bool bad_file = false;
  bool stopped = false;

  std::string text() const {
    return nlohmann::json{
        {"results", results}, {"error", error}, {"bad_file", bad_file}, {"stopped", stopped}}
        .dump();
  }
  void add(const std::string& text) {
    const auto json = nlohmann::json::parse(text);
    results.merge(json.at("results").get<std::map<std::size_t, std::string>>());
    stopped = stopped || json.at("stopped").get<bool>();
    if (error.empty()) {
      error = json.at("error").get<std::string>();
      bad_file = json.at("bad_file").get<bool>();
    }
  }
};

class Build {
 public:
  Build(const LibraryGrid& grid, const LibraryBuildOptions& options)
      : grid_(grid),
        options_(options),
        sharing_(options.sharing != nullptr ? *options.sharing : alone_),
        watch_(options) {
    require_buildable(grid, options);
    if (!options.folder.empty()) make_folder();
    for (const Machine& machine : grid.machines) {
      for (const SoilKind& soil : grid.soils) {
        for (const double slope : grid.slopes) {
          rows_.push_back({&machine, &soil, slope, {}, {}});
          rows_.back().densities.insert(grid.densities_percent.begin(),
                                        grid.densities_percent.end());
        }
      }
    }
  }

  LibraryBuild whole() {
    bool refined = true;
    while (refined && !stopped_) {
      compute(all_keys());
      refined = !stopped_ && measure_and_refine();
    }
    LibraryBuild build = summary(all_keys());
    if (!stopped_) {
      for (std::size_t first = 0; first < rows_.size(); first += grid_.slopes.size()) {
        build.libraries.push_back(library_of(first));
      }
    }
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
    compute(mine);
    return summary(mine);
  }

 private:
  struct Row {
    const Machine* machine;
    const SoilKind* soil;
    double slope;
    std::set<double> densities;
    std::map<std::pair<double, double>, MidwayError> midways;  ///< by the two densities
  };
  /// Row and density of a cell.
  using Key = std::pair<std::size_t, double>;

  void make_folder() const {
    std::error_code error;
    std::filesystem::create_directories(options_.folder, error);
    if (!std::filesystem::is_directory(options_.folder)) {
      throw Error(ErrorKind::bad_file, options_.folder + ": is not a folder and cannot be made");
    }
  }

  LibraryCell cell_of(const Key& key) const {
    const Row& row = rows_[key.first];
    return {row.machine, row.soil, row.slope, key.second};
  }

  std::vector<Key> all_keys() const {
    std::vector<Key> keys;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      for (const double density : rows_[row].densities) keys.push_back({row, density});
    }
    return keys;
  }

  LibraryBuild summary(const std::vector<Key>& wanted) const {
    LibraryBuild build;
    build.stopped = stopped_;
    build.cells = wanted.size();
    build.cells_done = static_cast<std::size_t>(std::count_if(
        wanted.begin(), wanted.end(), [&](const Key& key) { return outcomes_.count(key) == 1; }));
    return build;
  }

  /// Computes the cells, and before each those that it starts from.
  void compute(const std::vector<Key>& wanted) {
    std::vector<std::set<Key>> generations;
    for (const Key& key : wanted) add_with_parents(key, generations);
    std::size_t cells = outcomes_.size();
    for (const std::set<Key>& generation : generations) cells += missing(generation).size();
    watch_.expect(cells);
    for (const std::set<Key>& generation : generations) compute_at_once(missing(generation));
  }

  /// @return the generation of the cell: 0 if it is searched from nothing
  std::size_t add_with_parents(const Key& key, std::vector<std::set<Key>>& generations) const {
    std::size_t own = 0;
    for (const double parent : parent_densities(key.second, options_.search)) {
      own = std::max(own, 1 + add_with_parents({key.first, parent}, generations));
    }
    if (generations.size() <= own) generations.resize(own + 1);
    generations[own].insert(key);
    return own;
  }

  std::vector<Key> missing(const std::set<Key>& keys) const {
    std::vector<Key> left;
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(left),
                 [&](const Key& key) { return outcomes_.count(key) == 0; });
    return left;
  }

  /// Computes cells that do not depend on each other.
  void compute_at_once(const std::vector<Key>& keys) {
    const auto texts = share_out(keys.size(), [&](std::size_t i) { return text_of(keys[i]); });
    for (const auto& [i, text] : texts) {
      outcomes_[keys[i]] = read_cell("cell", text, cell_of(keys[i]), options_.search);
    }
  }

  /// The text of a cell's file, from the folder or computed; empty if stopped.
  std::string text_of(const Key& key) {
    const LibraryCell cell = cell_of(key);
    const std::string name = cell_file_name(cell, options_.search);
    if (const std::string kept = kept_text(cell, name); !kept.empty()) {
      watch_.cell_done(false);
      return kept;
    }
    if (options_.only_merge) {
      throw Error(ErrorKind::bad_file, options_.folder + "/" + name +
                                           ": is missing or damaged, the shard that computes it "
                                           "has not ended");
    }
    std::vector<CellOutcome> parents;
    for (const double parent : parent_densities(key.second, options_.search)) {
      parents.push_back(outcomes_.at({key.first, parent}));
    }
    const auto outcome =
        compute_cell(cell, options_.search, parents,
                     [&](const SearchProgress& now) { return watch_.dig_done(name, now.best); });
    if (!outcome) return {};
    const std::string text = cell_text(cell, options_.search, *outcome);
    if (!options_.folder.empty()) write_file(options_.folder + "/" + name, text);
    watch_.cell_done(true);
    return text;
  }

  std::string kept_text(const LibraryCell& cell, const std::string& name) const {
    const std::string path = options_.folder + "/" + name;
    if (options_.folder.empty() || !std::filesystem::exists(path)) return {};
    try {
      const std::string text = read_file(path);
      read_cell(path, text, cell, options_.search);
      return text;
    } catch (const Error& e) {
      if (options_.note) options_.note(std::string(e.what()) + "; it is computed anew");
      return {};
    }
  }

  /// Does task(0) .. task(count - 1), each in one process; all of them get all results. A task that
  /// was stopped gives an empty text.
  std::map<std::size_t, std::string> share_out(
      std::size_t count, const std::function<std::string(std::size_t)>& task) {
    if (count == 0 || stopped_) return {};
    Parcel mine;
    std::mutex mutex;
    const auto work = [&] {
      for (std::size_t i = sharing_.next(); i < count && !watch_.stopped(); i = sharing_.next()) {
        std::string text = task(i);
        const std::lock_guard<std::mutex> lock(mutex);
        if (!text.empty()) mine.results[i] = std::move(text);
      }
    };
    const std::size_t threads =
        options_.threads > 0 ? options_.threads : std::max(1u, std::thread::hardware_concurrency());
    try {
      parallel_for(std::min(threads, count), options_.threads, [&](std::size_t) { work(); });
    } catch (const Error& e) {
      mine.error = e.what();
      mine.bad_file = e.kind() == ErrorKind::bad_file;
    }
    mine.stopped = watch_.stopped();
    return exchange(mine);
  }

  std::map<std::size_t, std::string> exchange(const Parcel& mine) {
    Parcel all;
    for (const std::string& text : sharing_.exchange(mine.text())) all.add(text);
    if (!all.error.empty()) {
      throw Error(all.bad_file ? ErrorKind::bad_file : ErrorKind::bad_input, all.error);
    }
    stopped_ = stopped_ || all.stopped;
    return all.results;
  }

  const PathLibraryEntry* entry_at(std::size_t row, double density) const {
    const auto& entry = outcomes_.at({row, density}).entry;
    return entry ? &*entry : nullptr;
  }

  /// Two neighbouring densities of a row whose look-up is not measured yet.
  struct Pair {
    std::size_t row;
    double below;
    double above;
    double middle() const { return 0.5 * (below + above); }
  };

  std::vector<Pair> unmeasured() const {
    std::vector<Pair> pairs;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const std::set<double>& densities = rows_[r].densities;
      for (auto above = std::next(densities.begin()); above != densities.end(); ++above) {
        const double below = *std::prev(above);
        const bool measured = rows_[r].midways.count({below, *above}) == 1;
        if (!measured && entry_at(r, below) && entry_at(r, *above)) {
          pairs.push_back({r, below, *above});
        }
      }
    }
    return pairs;
  }

  /// Of the best dig midway, by the polynomial of the logarithm through up to four entries around.
  double expected_best(const Pair& pair) const {
    const std::set<double>& densities = rows_[pair.row].densities;
    auto from = densities.find(pair.below);
    auto to = densities.find(pair.above);
    if (from != densities.begin() && entry_at(pair.row, *std::prev(from))) --from;
    if (std::next(to) != densities.end() && entry_at(pair.row, *std::next(to))) ++to;
    double sum = 0.0;
    for (auto i = from; i != std::next(to); ++i) {
      double weight = std::log(entry_at(pair.row, *i)->dig.efficiency());
      for (auto j = from; j != std::next(to); ++j) {
        if (i != j) weight *= (pair.middle() - *j) / (*i - *j);
      }
      sum += weight;
    }
    return std::exp(sum);
  }

  std::string midway_text(const Pair& pair) const {
    const MidwayError error =
        measure_midway(cell_of({pair.row, pair.middle()}), options_.search.cell,
                       entry_at(pair.row, pair.below)->dig, entry_at(pair.row, pair.above)->dig,
                       expected_best(pair));
    return nlohmann::json{error.loss, error.expectation}.dump();
  }

  /// @return true if densities were added
  bool measure_and_refine() {
    const std::vector<Pair> pairs = unmeasured();
    const auto texts =
        share_out(pairs.size(), [&](std::size_t i) { return midway_text(pairs[i]); });
    bool refined = false;
    for (const auto& [i, text] : texts) {
      const Pair& pair = pairs[i];
      const auto numbers = nlohmann::json::parse(text).get<std::vector<double>>();
      rows_[pair.row].midways[{pair.below, pair.above}] = {numbers[0], numbers[1]};
      if (worth_refining(pair, numbers[0])) {
        rows_[pair.row].densities.insert(pair.middle());
        refined = true;
      }
    }
    return refined;
  }

  bool worth_refining(const Pair& pair, double loss) const {
    const double distance = pair.above - pair.below;
    if (options_.refine == 0.0 || distance < 2.0 * finest) return false;
    return distance > coarsest || loss > options_.refine;
  }

  PathLibrary library_of(std::size_t first) const {
    const Row& row = rows_[first];
    PathLibrary library{row.machine->name,
                        row.soil->name,
                        fingerprint(*row.machine),
                        fingerprint(*row.soil),
                        simulator_fingerprint(),
                        options_.search.cell,
                        options_.search.seed,
                        describe(options_.search),
                        {},
                        {}};
    for (std::size_t r = first; r < first + grid_.slopes.size(); ++r) add_row(r, library);
    if (library.entries.empty()) {
      throw Error(ErrorKind::bad_input, "library: no dig is feasible for " + library.machine +
                                            " in " + library.soil + " at any density");
    }
    return library;
  }

  void add_row(std::size_t r, PathLibrary& library) const {
    const std::set<double>& densities = rows_[r].densities;
    for (auto density = densities.begin(); density != densities.end(); ++density) {
      const PathLibraryEntry* found = entry_at(r, *density);
      if (found == nullptr) {
        library.gaps.push_back({*density, rows_[r].slope});
        continue;
      }
      PathLibraryEntry entry = *found;
      if (std::next(density) != densities.end()) {
        const auto midway = rows_[r].midways.find({*density, *std::next(density)});
        if (midway != rows_[r].midways.end()) {
          entry.midway = midway->second;
          ++entry.evaluations;
        }
      }
      library.entries.push_back(entry);
    }
  }

  const LibraryGrid& grid_;
  const LibraryBuildOptions& options_;
  Alone alone_;
  WorkSharing& sharing_;
  Watch watch_;
  std::vector<Row> rows_;  // slopes of a machine and soil stand together
  std::map<Key, CellOutcome> outcomes_;
  bool stopped_ = false;
};

}  // namespace

void require_buildable(const LibraryGrid& grid, const LibraryBuildOptions& options) {
  require(!grid.machines.empty(), "no machine is asked for");
  require(!grid.soils.empty(), "no soil is asked for");
  require_rising("densities [%]", grid.densities_percent, 0.0, 100.0);
  require_rising("slopes [rad]", grid.slopes, -1.0, 1.0);
  require(options.refine >= 0.0 && options.refine < 1.0,
          "refine must be in 0 .. 1, got " + number_text(options.refine));
  require(options.search.cell > 0.0 && options.search.cell <= 1.0,
          "the cell of the ground must be in 0 .. 1 m, got " + number_text(options.search.cell));
  require(!options.only_merge || !options.folder.empty(), "a merge needs a folder of cells");
}

LibraryBuild build_path_libraries(const LibraryGrid& grid, const LibraryBuildOptions& options) {
  return Build(grid, options).whole();
}

LibraryBuild build_library_shard(const LibraryGrid& grid, const LibraryShard& shard,
                                 const LibraryBuildOptions& options) {
  return Build(grid, options).part(shard);
}

}  // namespace excavplan
