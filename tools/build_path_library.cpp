// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/library/library_build.hpp>

#include "base/text.hpp"
#include "shared/entry_folder.hpp"
#include "shared/goal_inputs.hpp"
#include "shared/library_results.hpp"
#include "shared/ranks.hpp"
#include "shared/results.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "build-path-library",
    "searches in the simulator for the best dig for a goal at each density of a soil, and writes "
    "the digs to a path library for plan-path. Several machines, soils and slopes give one "
    "library per machine and soil. Runs in parallel in threads and under mpirun, with the same "
    "result.",
    {{"build-path-library --out loam.json", "the default: 0, 5 .. 100 % in loam with the ZX120"},
     {"build-path-library --soil sand --densities 20:10:80 --out sand.json", "a coarser library"},
     {"build-path-library --out loam.json --resume", "resume an interrupted build"},
     {"build-path-library --soil loam,sand,clay --slopes=-10deg,0,10deg --out libraries",
      "three libraries of three slopes each in the folder libraries"},
     {"mpirun -n 4 build-path-library --out loam.json", "in four processes"}},
    false,
    true};

struct Inputs {
  std::string densities = "0:5:100";
  std::string slopes = "0";
  std::string soils = "loam";
  std::string machines = "zx120";
  std::string simulator = default_simulator().word;
  GoalInputs goal;
  std::string method = "memetic";
  AnchoredSearch anchored;
  GeneticAlgorithm genetic;
  LibrarySearch search;
  std::uint64_t threads = 0;
  bool resume = false;
  std::optional<std::string> cells;
  std::string out;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c");
  arguments.text("slopes", "LIST", inputs.slopes,
                 "slopes of the ground, rising away from the machine: first:step:last or a,b,c "
                 "[rad]");
  arguments.text("soil", "NAME,..", inputs.soils, "loam, sand, clay, gravel or soil files");
  arguments.text("machine", "NAME,..", inputs.machines, "zx120 or machine files");
  arguments.simulator(inputs.simulator);
  declare_goal(arguments, inputs.goal);
  arguments.choice("method", inputs.method, {"memetic", "paper"},
                   "memetic: three densities without a warm start, the others from neighbours; "
                   "paper: a genetic algorithm for each");
  arguments.option("points", inputs.anchored.points,
                   "memetic: initial digs of a search without a warm start");
  arguments.option("polish", inputs.anchored.polish_evaluations,
                   "memetic: simulated digs of one Nelder-Mead search");
  arguments.option("inherited", inputs.anchored.inherited_evaluations,
                   "memetic: simulated digs of a density that starts from its neighbours");
  arguments.option("population", inputs.genetic.population, "paper: population of a generation");
  arguments.option("generations", inputs.genetic.generations, "paper: generations of a search");
  arguments.option("cell", inputs.search.cell_size, Quantity::length,
                   "cell size of the simulated ground");
  arguments.option("seed", inputs.search.seed, "seed; the same seed gives the same file");
  arguments.threads(inputs.threads, "; same file for any");
  arguments.place("cells", inputs.cells,
                  "folder for the results of each density; kept, reused by later runs and shared "
                  "by parallel ones (default: beside --out, removed at the end)");
  arguments.flag("resume", inputs.resume, "reuse results of an interrupted run with this --out");
  arguments.place("out", inputs.out,
                  "library to write; with several machines or soils a folder for "
                  "MACHINE-SOIL-GOAL.json of each");
  arguments.require("out");
}

const OptionNames option_names = {{"library: densities", "--densities"},
                                  {"library: slopes", "--slopes"},
                                  cell_option[0],
                                  {"machines x soils x slopes x densities of a library",
                                   "--machine x --soil x --slopes x --densities"},
                                  {"points of a library search", "--points"},
                                  {"search: first_generation", "--points"},
                                  {"polish evaluations of a library search", "--polish"},
                                  {"inherited evaluations of a library search", "--inherited"},
                                  {"search: population", "--population"},
                                  {"search: generations", "--generations"}};

LibraryGrid grid_of(const Inputs& inputs) {
  LibraryGrid grid;
  for (const std::string& name : split(inputs.machines, ',')) {
    grid.machines.push_back(machine_named(name));
  }
  for (const std::string& name : split(inputs.soils, ',')) grid.soils.push_back(soil_named(name));
  grid.slopes = parse_series("--slopes", inputs.slopes, Quantity::angle);
  grid.densities_percent = parse_densities("--densities", inputs.densities);
  return grid;
}

/// Of options that only the other method has.
std::vector<Warning> warnings_of(const Inputs& inputs) {
  const AnchoredSearch anchored;
  const GeneticAlgorithm genetic;
  const bool paper = inputs.method == "paper";
  IgnoredOptions ignored;
  ignored.add(paper && inputs.anchored.points != anchored.points, "--points");
  ignored.add(paper && inputs.anchored.polish_evaluations != anchored.polish_evaluations,
              "--polish");
  ignored.add(paper && inputs.anchored.inherited_evaluations != anchored.inherited_evaluations,
              "--inherited");
  ignored.add(!paper && inputs.genetic.population != genetic.population, "--population");
  ignored.add(!paper && inputs.genetic.generations != genetic.generations, "--generations");
  return ignored.warnings("--method " + inputs.method + " has none");
}

LibraryBuildOptions options_of(const Inputs& inputs, Console& console) {
  LibraryBuildOptions options;
  options.search = inputs.search;
  options.search.objective = objective_of(inputs.goal);
  options.search.simulator = simulator_of_word(inputs.simulator);
  options.search.method = inputs.anchored;
  if (inputs.method == "paper") options.search.method = inputs.genetic;
  options.threads = static_cast<unsigned>(inputs.threads);
  options.folder = inputs.cells.value_or(inputs.out + ".cells");
  options.note = [&console](const std::string& line) { console.note(line); };
  options.progress = [&console, watch = Stopwatch(),
                      objective = options.search.objective](const LibraryProgress& now) {
    const auto done = static_cast<double>(now.entries_done);
    const auto all = static_cast<double>(now.entries);
    const double seconds = watch.seconds() * (all - done) / done;
    const std::string left = done > 0.0 ? ", " + readable(seconds, 2) + " s left" : "";
    console.progress(done / all, std::to_string(now.entries_done) + " of " +
                                     std::to_string(now.entries) + " densities, " +
                                     std::to_string(now.evaluations) + " digs, now " +
                                     worth_text(objective, now.best) + left);
    return !console.stop_requested();
  };
  return options;
}

Outcome work(const Inputs& inputs, Console& console, Ranks* ranks) {
  const Stopwatch watch;
  const LibraryGrid grid = grid_of(inputs);
  LibraryBuildOptions options = options_of(inputs, console);
  naming_options(option_names, [&] { require_buildable(grid, options.search); });
  if (ranks != nullptr) {
    if (options.threads == 0) options.threads = 1;
    ranks->agree(options.threads);
    if (ranks->rank() != 0) {
      ranks->serve(library_worker(grid, options.search));
      return {};
    }
    options.other_workers = ranks->workers();
  }
  require_library_place(grid, options.search.objective, inputs.out);
  std::optional<EntryFolder> own;
  if (!inputs.cells) own.emplace(options.folder, inputs.resume);
  const LibraryBuild build =
      naming_options(option_names, [&] { return build_path_libraries(grid, options); });
  Outcome outcome = build.stopped ? stopped_build(build, options.folder,
                                                  inputs.cells ? "the same command" : "--resume")
                                  : written_libraries(build.libraries, inputs.out);
  if (own) build.stopped ? own->keep() : own->clear();
  outcome.json["wall_time_s"] = watch.seconds();
  outcome.warnings = warnings_of(inputs);
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return run_ranked(argc, argv, [](int count, const char* const* words, Ranks* ranks) {
    return tool_main(count, words, about, declare, [ranks](const Inputs& inputs, Console& console) {
      return work(inputs, console, ranks);
    });
  });
}
