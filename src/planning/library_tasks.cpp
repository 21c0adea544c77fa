// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "planning/library_tasks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <excavplan/base/error.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "optimisation/search_checkpoint.hpp"
#include "planning/dig_attempts.hpp"
#include "planning/planned_digs.hpp"
#include "simulation/checked_dig.hpp"

namespace excavplan {

// As text between processes and in files: every number as it is.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LibraryPlace, machine, soil, slope, density_percent)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LibraryTask, place, digs, starts, expected, known)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LibraryAnswer, feasible, dig, rank, evaluations, measured)

namespace {

constexpr const char* entry_format = "excavplan-library-entry";
constexpr std::size_t longest_identity = 65536;  // [byte]; ours
constexpr std::size_t longest_shown = 400;       // of one in a message [byte]

// Searched from nothing, and how far apart densities are that start from one another [%]; ours,
// after docs/methods.md#library.
constexpr double anchors[] = {0.0, 50.0, 100.0};
constexpr double stride = 10.0;

// How much below the line through two others an efficiency may be, between and beyond them; the
// logarithm of the efficiency bends less. And what the gain must be for a dig of another kind.
// Ours.
constexpr double slack_between = 0.006;
constexpr double slack_beyond = 0.025;
constexpr double clearly_more = 0.002;

double nearest_anchor(double density) {
  return *std::min_element(std::begin(anchors), std::end(anchors), [density](double a, double b) {
    return std::abs(a - density) < std::abs(b - density);
  });
}

/// All that decides what the first search for a place finds; the seed of all its searches.
std::string identity(const LibraryJob& job, const LibraryPlace& place) {
  const LibrarySearch& search = job.search;
  return "machine " + fingerprint(job.grid.machines[place.machine]) + ", soil " +
         fingerprint(job.grid.soils[place.soil]) + ", simulator " + search.simulator.name +
         " on cells of " + number_text(search.cell_size) + " m, slope " + number_text(place.slope) +
         " rad, density " + number_text(place.density_percent) + " %, seed " +
         std::to_string(search.seed) + ", goal " + describe(search.objective) + ", " +
         describe(search) + ", start " + describe(DigSearchOptions{}.start_rule);
}

/// From nothing.
/// @param effort  number of times as many points as usual
DigSearchOptions cold_search(const LibrarySearch& search, int effort) {
  if (const auto* anchored = std::get_if<AnchoredSearch>(&search.method)) {
    return polish_search(effort * anchored->points, anchored->basins, anchored->polish_evaluations);
  }
  DigSearchOptions options;
  options.method = std::get<GeneticAlgorithm>(search.method);
  return options;
}

/// A polish, and one more from its best with the simplex spread again.
DigSearchOptions warm_search(const LibrarySearch& search,
                             const std::vector<DigParameters>& starts) {
  const int evaluations = std::get<AnchoredSearch>(search.method).inherited_evaluations;
  DigSearchOptions options = polish_search(0, 1, evaluations / 2);
  options.start.assign(starts.begin(), starts.end());
  options.stop.evaluations = evaluations;
  return options;
}

/// Does the searches of one place, all with the same seed.
class EntrySearch {
 public:
  EntrySearch(const LibrarySearch& search, std::uint64_t seed, DigAttempts& attempts)
      : search_(search), seed_(seed), attempts_(attempts) {}

  void first(const LibraryTask& task) {
    if (!task.starts.empty()) attempt(warm_search(search_, task.starts));
    if (!task.starts.empty() && !attempts_.best()) {
      std::vector<DigParameters> shallower(2, task.starts.back());
      shallower[0].penetration_length *= 0.85;
      shallower[1].penetration_length *= 0.7;
      attempt(warm_search(search_, shallower));
    }
    if (!attempts_.best() || attempts_.rank() < task.expected) {
      attempt(cold_search(search_, 1));
    }
    const bool anchored = std::holds_alternative<AnchoredSearch>(search_.method);
    if (anchored && !attempts_.fills_enough()) attempt(cold_search(search_, 8));
  }

  /// Half the effort, and the other half where it pays. @return whether it did
  bool improve(const LibraryTask& task) {
    DigSearchOptions half = warm_search(search_, task.starts);
    half.stop.evaluations /= 2;
    attempt(half);
    if (attempts_.rank() <= (1.0 + clearly_more) * task.known) return false;
    half.start = {attempts_.best()->parameters};
    attempt(half);
    return true;
  }

 private:
  void attempt(DigSearchOptions options) {
    options.seed = seed_;
    attempts_.search(std::move(options));
  }

  const LibrarySearch& search_;
  const std::uint64_t seed_;
  DigAttempts& attempts_;
};

template <typename Value>
Value value_of(const std::string& name, const nlohmann::json& json) {
  try {
    return json.get<Value>();
  } catch (const nlohmann::json::exception& e) {
    throw Error(ErrorKind::bad_file, name + ": " + e.what());
  }
}

LibraryTask read_task(const LibraryJob& job, const std::string& text) {
  const auto read = [&] {
    try {
      return value_of<LibraryTask>("task", parse_json("task", text));
    } catch (const Error&) {
      refuse("library worker: " + in_quotes(text) + " is no task of a build");
    }
  };
  LibraryTask task = read();
  require(task.place.machine < job.grid.machines.size() && task.place.soil < job.grid.soils.size(),
          "library worker: the task is one of another grid");
  return task;
}

LibraryAnswer answer(const LibraryJob& job, const LibraryTask& task, DigAttempts& attempts) {
  LibraryAnswer answer;
  EntrySearch search(job.search, checksum(identity(job, task.place)), attempts);
  for (const PlannedDig& dig : task.digs) answer.measured.push_back(attempts.measure(dig));
  if (task.digs.empty()) {
    if (task.known > 0.0) {
      answer.feasible = search.improve(task);
    } else {
      search.first(task);
      answer.feasible = attempts.best().has_value();
    }
    if (answer.feasible) answer.dig = *attempts.best();
    if (answer.feasible) answer.rank = attempts.rank();
  }
  answer.evaluations = attempts.evaluations();
  return answer;
}

}  // namespace

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

LibraryTask first_search(const LibraryJob& job, const LibraryPlace& place,
                         const std::vector<std::pair<double, PlannedDig>>& parents) {
  LibraryTask task{place};
  if (parents.empty()) return task;
  const auto& [near_density, near] = parents.front();
  const auto& [far_density, far] = parents.back();
  if (far_apart(near, far)) {
    task.starts.push_back(far.parameters);
  } else if (parents.size() == 2) {
    const double share = (place.density_percent - near_density) / (far_density - near_density);
    DigParameters there = dig_between(near, far, share).parameters;
    const DigBounds bounds = machine_bounds(job.grid.machines[place.machine]);
    for (const DigParameterInfo& info : dig_parameter_table()) {
      double& number = there.*info.field;
      number = std::clamp(number, bounds.lower.*info.field, bounds.upper.*info.field);
    }
    task.starts.push_back(there);
    const DigObjective& objective = job.search.objective;
    task.expected =
        (1.0 - (share > 0.0 ? slack_between : slack_beyond)) *
        log_polynomial({{near_density, objective.rank(near)}, {far_density, objective.rank(far)}},
                       place.density_percent);
  }
  task.starts.push_back(near.parameters);
  return task;
}

std::string describe(const LibrarySearch& search) {
  if (const auto* method = std::get_if<GeneticAlgorithm>(&search.method)) return describe(*method);
  const auto& method = std::get<AnchoredSearch>(search.method);
  return "anchors: " + std::to_string(method.points) + " points, " + std::to_string(method.basins) +
         " basins, polish of " + std::to_string(method.polish_evaluations) +
         "; others: " + std::to_string(method.inherited_evaluations) + " from neighbours";
}

std::string entry_file_name(const LibraryJob& job, const LibraryPlace& place) {
  return file_name_part(job.grid.machines[place.machine].name) + "-" +
         file_name_part(job.grid.soils[place.soil].name) + "-slope" + number_text(place.slope) +
         "-density" + number_text(place.density_percent) + "-" +
         checksum_text(identity(job, place)) + entry_file_end;
}

std::string to_text(const LibraryTask& task) { return nlohmann::json(task).dump(); }

std::string do_task(const LibraryJob& job, const std::string& text,
                    const std::function<bool(int digs, double best)>& progress) {
  const LibraryTask task = read_task(job, text);
  const LibraryPlace& place = task.place;
  const Machine& machine = job.grid.machines[place.machine];
  DigAttempts attempts(machine, job.search.objective,
                       make_simulator(job.search.simulator, machine, job.grid.soils[place.soil],
                                      place.density_percent),
                       sloped_planning_ground(machine, place.slope, job.search.cell_size),
                       progress);
  const LibraryAnswer found = answer(job, task, attempts);
  if (attempts.stopped()) return {};
  return sealed_text({{"format", entry_format},
                      {"version", 1},
                      {"identity", identity(job, place)},
                      {"answer", nlohmann::json(found)}});
}

LibraryAnswer read_answer(const LibraryJob& job, const LibraryPlace& place, const std::string& name,
                          const std::string& text) {
  JsonObject file = JsonObject::open_sealed(name, text, entry_format);
  const std::string wanted = identity(job, place);
  if (const std::string own = file.text("identity", longest_identity); own != wanted) {
    file.fail("identity", "is '" + safe_text(own, longest_shown) +
                              "', which is another entry than '" +
                              safe_text(wanted, longest_shown) + "'");
  }
  constexpr double most_evaluations = 1e9;
  file.object("answer").number("evaluations", 0.0, most_evaluations);
  return value_of<LibraryAnswer>(name + ": answer", parse_json(name, text)["answer"]);
}

}  // namespace excavplan
