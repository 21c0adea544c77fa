// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/library_build.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/parallel.hpp"
#include "base/task_queue.hpp"
#include "base/text.hpp"
#include "planning/library_tasks.hpp"
#include "planning/planned_digs.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

void require_rising(const std::string& what, const std::vector<double>& values, double lowest,
                    double highest) {
  require(!values.empty(), "library: no " + what + " is asked for");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool rising = i == 0 || values[i] > values[i - 1];
    require(values[i] >= lowest && values[i] <= highest && rising,
            "library: " + what + " must rise inside " + number_text(lowest) + " .. " +
                number_text(highest) + ", got " + number_text(values[i]) + " at place " +
                std::to_string(i + 1));
  }
}

/// Else neither library nor entry could be read again.
void require_name(const std::string& what, const std::string& name) {
  const auto fault = fault_of_line(name, longest_text);
  if (fault) refuse("library: the name of a " + what + " is " + *fault);
}

/// Libraries are told apart by the names of their machine and soil.
template <typename Named>
void require_unlike(const std::string& what, const std::vector<Named>& all) {
  require(!all.empty(), "library: no " + what + " is asked for");
  std::set<std::string> names;
  for (const Named& one : all) {
    require_name(what, one.name);
    require(names.insert(file_name_part(one.name)).second,
            "library: two of the " + what + "s are named '" + one.name + "', or alike");
  }
}

/// Also if a killed run left it half written.
bool is_entry_file(const std::string& name) {
  const std::string rest = name.substr(std::min(name.size(), name.find(entry_file_end)));
  return rest == entry_file_end || rest.rfind(entry_file_end + std::string(".part-"), 0) == 0;
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(folder, error); !error && file != fs::directory_iterator();
       file.increment(error)) {
    names.push_back(file->path().filename());
  }
  if (error) throw Error(ErrorKind::bad_file, folder + ": cannot be read: " + error.message());
  return names;
}

/// What the user sees of a build, and whether it was stopped.
class Watch {
 public:
  explicit Watch(const LibraryBuildOptions& options) : options_(options) {}

  void expect_entry() { ++now_.entries; }
  /// @return false once stopped
  template <typename Change>
  bool tell(const Change& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(now_);
    if (options_.progress && !stopped_ && !options_.progress(now_)) stopped_ = true;
    return !stopped_;
  }
  void note(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (options_.note) options_.note(line);
  }
  bool stopped() const { return stopped_; }
  const LibraryProgress& now() const { return now_; }

 private:
  const LibraryBuildOptions& options_;
  std::mutex mutex_;
  LibraryProgress now_;
  std::atomic<bool> stopped_{false};
};

/// Of what is looked up midway between two digs.
/// @param best  worth of the best dig there
/// @param measured  worths there of their mix and of both
Interpolation interpolation(const DigObjective& objective, const PlannedDig& below,
                            const PlannedDig& above, double best,
                            const std::vector<double>& measured) {
  constexpr double better = 0.03;  // than the rules before, of the best; ours
  const double lower = measured[1];
  const double upper = measured[2];
  Between between = Between::mix;
  double worth = measured[0];
  const auto prefer = [&](Between rule, double its_worth) {
    if (its_worth <= worth + (rule == Between::nearest ? 0.0 : better * best)) return;
    between = rule;
    worth = its_worth;
  };
  if (far_apart(below, above)) prefer(Between::nearest, std::min(lower, upper));
  prefer(Between::upper, upper);
  prefer(Between::lower, lower);
  const bool of_upper = between == Between::upper || (between == Between::nearest && upper < lower);
  const PlannedDig taken = between == Between::mix ? dig_between(below, above, 0.5)
                           : of_upper              ? above
                                                   : below;
  return {{std::clamp(1.0 - worth / best, 0.0, 1.0),
           worth > 0.0 ? objective.worth(taken) / worth - 1.0 : 0.0},
          between};
}

/// Whose digs are worth making where the goal lets the bucket be empty.
LibraryJob job_of(LibraryGrid grid, LibrarySearch search) {
  search.objective = search.objective.worthwhile();
  return {std::move(grid), std::move(search)};
}

/// Lays out all tasks of a build, and has them done.
///
/// Every entry is searched. Then, once up and once down each slope, an entry is searched again
/// whose neighbour has a dig of another kind, from that dig, or which is worse than its neighbours
/// let expect, from theirs; then so from slope to slope, where the kind differs. Then what is
/// looked up midway is dug.
class Build {
 public:
  Build(const LibraryGrid& grid, const LibraryBuildOptions& options)
      : job_(job_of(grid, options.search)),
        options_(options),
        watch_(options),
        queue_(options.folder.empty() ? 0 : std::random_device{}()) {
    for (std::size_t machine = 0; machine < grid.machines.size(); ++machine) {
      for (std::size_t soil = 0; soil < grid.soils.size(); ++soil) {
        for (const double slope : grid.slopes) {
          for (const double density : grid.densities_percent) {
            entries_.push_back(&searched({machine, soil, slope, density}));
          }
        }
      }
    }
    const std::size_t row = grid.densities_percent.size();
    if (std::holds_alternative<AnchoredSearch>(options.search.method)) {
      improve_along(1, row);
      improve_along(row, grid.slopes.size());
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      measure(i, {1, row, &LibraryPlace::density_percent, &Entry::to_next_density});
      measure(i, {row, grid.slopes.size(), &LibraryPlace::slope, &Entry::to_next_slope});
    }
  }

  LibraryBuild run() {
    if (!options_.folder.empty()) {
      make_folder(options_.folder);
      note_unused_entries();
    }
    std::vector<TaskQueue::Worker> workers(
        thread_count(options_.threads), [this](const std::string& task) {
          return do_task(job_, task, [this](int digs, double best) {
            return watch_.tell([=](LibraryProgress& now) {
              now.evaluations += digs;
              now.best = best;
            });
          });
        });
    for (const LibraryWorker& other : options_.other_workers) {
      workers.emplace_back(
          [this, &other](const std::string& task) { return watch_.stopped() ? "" : other(task); });
    }
    LibraryBuild build;
    build.stopped = !queue_.run(workers);
    build.entries = watch_.now().entries;
    build.entries_done = watch_.now().entries_done;
    if (!build.stopped) build.libraries = libraries();
    return build;
  }

 private:
  struct Entry {
    LibraryPlace place;
    LibraryAnswer first;  ///< of its own search
    LibraryAnswer found;  ///< after those from its neighbours
    Interpolation to_next_density;
    Interpolation to_next_slope;
    std::size_t searched = 0;               ///< task after which `first` is known
    std::size_t settled = 0;                ///< task after which `found` is final
    std::vector<std::size_t> readers = {};  ///< tasks that look at `found` as it is then
  };

  /// An entry, and before it those that its search starts from.
  Entry& searched(const LibraryPlace& place) {
    const auto [at, fresh] =
        all_.try_emplace(std::tuple(place.machine, place.soil, place.slope, place.density_percent));
    Entry& entry = at->second;
    if (!fresh) return entry;
    entry.place = place;
    std::vector<const Entry*> parents;
    std::vector<std::size_t> after;
    for (const double density : parent_densities(place.density_percent, job_.search)) {
      parents.push_back(&searched({place.machine, place.soil, place.slope, density}));
      after.push_back(parents.back()->searched);
    }
    watch_.expect_entry();
    const std::string file = options_.folder + "/" + entry_file_name(job_, place);
    entry.searched = entry.settled = queue_.add(
        {after, [=, &entry] { return kept(file, entry) ? "" : first_task(entry, parents); },
         [=, &entry](const std::string& text) {
           entry.first = entry.found = read_answer(job_, entry.place, "task", text);
           if (!options_.folder.empty()) write_journal(file, text);
           watch_.tell([](LibraryProgress& now) { ++now.entries_done; });
         }});
    return entry;
  }

  std::string first_task(const Entry& entry, const std::vector<const Entry*>& parents) const {
    std::vector<std::pair<double, PlannedDig>> digs;
    for (const Entry* parent : parents) {
      if (!parent->first.feasible) continue;
      digs.emplace_back(parent->place.density_percent, parent->first.dig);
    }
    return to_text(first_search(job_, entry.place, digs));
  }

  /// Says how many entries in the folder belong to builds with other options.
  void note_unused_entries() {
    std::set<std::string> own;
    for (const auto& [place, entry] : all_) own.insert(entry_file_name(job_, entry.place));
    int others = 0;
    for (const std::string& name : names_in(options_.folder)) {
      const std::string entry = name.substr(0, name.find(entry_file_end)) + entry_file_end;
      if (is_entry_file(name) && own.count(entry) == 0) ++others;
    }
    if (others == 0) return;
    watch_.note(options_.folder + ": " + std::to_string(others) +
                " entries of other options are not used");
  }

  /// Takes what the folder has of an entry.
  bool kept(const std::string& file, Entry& entry) {
    std::error_code none;
    const bool is_there = fs::exists(fs::symlink_status(file, none));
    if (options_.folder.empty() || !is_there) return false;
    if (!fs::is_regular_file(file, none)) {
      throw Error(ErrorKind::bad_file, file + ": is not a regular file");  // as a pipe, which waits
    }
    try {
      entry.first = entry.found = read_answer(job_, entry.place, file, read_file(file));
    } catch (const Error& e) {
      watch_.note(std::string(e.what()) + "; it is computed again");
      return false;
    }
    watch_.tell([](LibraryProgress& now) { ++now.entries_done; });
    return true;
  }

  /// Once up and once down the lines of so many entries, from one to the next by this step.
  void improve_along(std::size_t step, std::size_t count) {
    const auto has_below = [=](std::size_t i) { return i / step % count > 0; };
    const auto has_above = [=](std::size_t i) { return i / step % count + 1 < count; };
    const bool is_row = step == 1;  // others are of one density, where nothing is interpolated
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (has_below(i)) improve(i, i - step, is_row && has_above(i) ? i + step : i - step);
    }
    for (std::size_t i = entries_.size(); i-- > 0;) {
      if (has_above(i)) improve(i, i + step, is_row && has_below(i) ? i - step : i + step);
    }
  }

  /// @param next   the neighbour whose dig may be of a better kind
  /// @param other  the neighbour on the other side; `next` again if there is none, or no matter
  void improve(std::size_t own, std::size_t next, std::size_t other) {
    Entry& entry = *entries_[own];
    Entry& near = *entries_[next];
    Entry& far = *entries_[other];
    const auto task = [&entry, &near, &far, this] {
      LibraryTask improve{entry.place};
      improve.known = entry.found.rank;
      if (!entry.found.feasible || !near.found.feasible) return std::string();
      if (far_apart(entry.found.dig, near.found.dig)) {
        improve.starts = {near.found.dig.parameters};
        return to_text(improve);
      }
      if (&near == &far || !far.found.feasible) return std::string();
      const LibraryTask line = first_search(job_, entry.place,
                                            {{near.place.density_percent, near.found.dig},
                                             {far.place.density_percent, far.found.dig}});
      improve.starts = line.starts;
      return improve.known < line.expected ? to_text(improve) : std::string();
    };
    // Only after those that look at what it changes: else their order would decide what they see.
    std::vector<std::size_t> after = std::exchange(entry.readers, {});
    after.insert(after.end(), {entry.settled, near.settled, far.settled});
    entry.settled = queue_.add({after, task, [&entry, this](const std::string& text) {
                                  LibraryAnswer answer =
                                      read_answer(job_, entry.place, "task", text);
                                  answer.evaluations += entry.found.evaluations;
                                  if (answer.rank > entry.found.rank) {
                                    entry.found = answer;
                                  } else {
                                    entry.found.evaluations = answer.evaluations;
                                  }
                                }});
    near.readers.push_back(entry.settled);
    far.readers.push_back(entry.settled);
  }

  /// The entries in a line along density or slope.
  struct Line {
    std::size_t step;   ///< from one to the next, in entries_
    std::size_t count;  ///< of the line
    double LibraryPlace::*along;
    Interpolation Entry::*to_next;
  };

  /// Digs what is looked up midway between an entry and the next of a line.
  void measure(std::size_t i, const Line& line) {
    const std::size_t own = i / line.step % line.count;
    if (own + 1 == line.count) return;
    Entry& below = *entries_[i];
    const Entry& above = *entries_[i + line.step];
    std::vector<const Entry*> around = {&below, &above};
    if (own > 0) around.push_back(entries_[i - line.step]);
    if (own + 2 < line.count) around.push_back(entries_[i + 2 * line.step]);
    std::vector<std::size_t> after;
    after.reserve(around.size());
    for (const Entry* entry : around) after.push_back(entry->settled);
    LibraryPlace middle = below.place;
    middle.*line.along = 0.5 * (below.place.*line.along + above.place.*line.along);
    queue_.add({after, [=, &below, &above] { return midway_task(middle, below, above); },
                [=, &below, &above](const std::string& text) {
                  const DigObjective& goal = job_.search.objective;
                  const LibraryAnswer answer = read_answer(job_, middle, "task", text);
                  require(answer.measured.size() == 3, "digs measured by a library worker",
                          static_cast<double>(answer.measured.size()), "3");
                  std::vector<std::pair<double, double>> known;
                  for (const Entry* entry : around) {
                    if (!entry->found.feasible) continue;
                    known.emplace_back(entry->place.*line.along, goal.worth(entry->found.dig));
                  }
                  below.*line.to_next =
                      interpolation(goal, below.found.dig, above.found.dig,
                                    log_polynomial(known, middle.*line.along), answer.measured);
                  below.found.evaluations += answer.evaluations;
                }});
  }

  static std::string midway_task(const LibraryPlace& middle, const Entry& below,
                                 const Entry& above) {
    if (!below.found.feasible || !above.found.feasible) return {};
    const PlannedDig& a = below.found.dig;
    const PlannedDig& b = above.found.dig;
    return to_text(LibraryTask{middle, {dig_between(a, b, 0.5), a, b}});
  }

  std::vector<PathLibrary> libraries() const {
    std::vector<PathLibrary> all;
    const std::size_t size = job_.grid.slopes.size() * job_.grid.densities_percent.size();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = *entries_[i];
      if (i % size == 0) all.push_back(empty_library(entry.place));
      const double density = entry.place.density_percent;
      if (entry.found.feasible) {
        all.back().entries.push_back({density, entry.place.slope, entry.found.dig,
                                      entry.found.evaluations, entry.to_next_density,
                                      entry.to_next_slope});
      } else {
        all.back().gaps.push_back({density, entry.place.slope});
      }
      require(i % size + 1 < size || !all.back().entries.empty(),
              "library: no dig is feasible for " + all.back().machine + " in " + all.back().soil +
                  " at any density");
    }
    return all;
  }

  PathLibrary empty_library(const LibraryPlace& place) const {
    const Machine& machine = job_.grid.machines[place.machine];
    const SoilKind& soil = job_.grid.soils[place.soil];
    const LibrarySearch& search = job_.search;
    return {machine.name,
            soil.name,
            fingerprint(machine),
            fingerprint(soil),
            search.simulator.name,
            search.cell_size,
            search.seed,
            options_.search.objective,
            describe(search),
            {},
            {}};
  }

  const LibraryJob job_;
  const LibraryBuildOptions& options_;
  Watch watch_;
  TaskQueue queue_;
  std::map<std::tuple<std::size_t, std::size_t, double, double>, Entry> all_;
  std::vector<Entry*> entries_;  ///< of the grid: machine, soil, slope, density
};

}  // namespace

void require_buildable(const LibraryGrid& grid, const LibrarySearch& search) {
  require_unlike("machine", grid.machines);
  require_unlike("soil", grid.soils);
  require_rising("densities [%]", grid.densities_percent, 0.0, 100.0);
  require_rising("slopes [rad]", grid.slopes, -1.0, 1.0);
  for (const Machine& machine : grid.machines) {
    require_machine(machine);
    check(search.objective, machine);
  }
  for (const SoilKind& soil : grid.soils) require_soil(soil);
  require_name("simulator", search.simulator.name);
  if (!search.simulator.make) {
    refuse("library: simulator " + in_quotes(search.simulator.name) +
           " has no function that makes one");
  }
  const double entries = static_cast<double>(grid.machines.size() * grid.soils.size()) *
                         static_cast<double>(grid.slopes.size() * grid.densities_percent.size());
  require(entries <= most_library_entries, "machines x soils x slopes x densities of a library",
          entries, "at most " + std::to_string(most_library_entries));
  require(search.seed <= most_exact, "seed of a library", static_cast<double>(search.seed),
          "at most " + std::to_string(most_exact) + ", which its file keeps");
  if (const auto* anchored = std::get_if<AnchoredSearch>(&search.method)) {
    require_in("points of a library search", anchored->points, 1, most_evaluations);
    require_in("basins of a library search", anchored->basins, 0, most_evaluations);
    require_in("polish evaluations of a library search", anchored->polish_evaluations, 0,
               most_evaluations);
    require_in("inherited evaluations of a library search", anchored->inherited_evaluations, 0,
               most_evaluations);
  }
  require_simulated_cell(search.cell_size);
}

LibraryWorker library_worker(LibraryGrid grid, LibrarySearch search) {
  require_buildable(grid, search);
  return [job = job_of(std::move(grid), std::move(search))](const std::string& task) {
    return do_task(job, task, {});
  };
}

LibraryBuild build_path_libraries(const LibraryGrid& grid, const LibraryBuildOptions& options) {
  require_buildable(grid, options.search);
  for (const LibraryWorker& worker : options.other_workers) {
    require(static_cast<bool>(worker), "library: one of its other_workers is an empty function");
  }
  return Build(grid, options).run();
}

void remove_library_entries(const std::string& folder) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) return;
  for (const std::string& name : names_in(folder)) {
    std::error_code taken_by_another_run;
    if (is_entry_file(name)) fs::remove(fs::path(folder) / name, taken_by_another_run);
  }
  std::error_code not_empty;
  fs::remove(folder, not_empty);
}

}  // namespace excavplan
