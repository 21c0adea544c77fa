// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/library_build.hpp>

#include "build_path_library/entry_folder.hpp"
#include "build_path_library/library_inputs.hpp"
#include "build_path_library/library_results.hpp"
#include "build_path_library/ranks.hpp"
#include "frame/tool.hpp"
#include "results/results.hpp"

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
  LibraryInputs library;
  std::uint64_t threads = 0;
  bool resume = false;
  std::optional<std::string> cells;
  std::string out;
};

void declare(Arguments& arguments, Inputs& inputs) {
  declare_library(arguments, inputs.library);
  arguments.threads(inputs.threads, "; same file for any");
  arguments.folder("cells", inputs.cells,
                   "for the results of each density; kept, reused by later runs and shared by "
                   "parallel ones (default: beside --out, removed at the end)");
  arguments.flag("resume", inputs.resume, "reuse results of an interrupted run with this --out");
  arguments.place("out", inputs.out,
                  "library to write; with several machines or soils a folder for "
                  "MACHINE-SOIL-GOAL.json of each");
  arguments.require("out");
}

LibraryBuildOptions options_of(const Inputs& inputs, const LibraryGrid& grid, Console& console) {
  LibraryBuildOptions options;
  options.search = search_of(inputs.library, grid, console);
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
  const LibraryGrid grid = grid_of(inputs.library);
  LibraryBuildOptions options = options_of(inputs, grid, console);
  naming_options(library_option_names, [&] { require_buildable(grid, options.search); });
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
      naming_options(library_option_names, [&] { return build_path_libraries(grid, options); });
  Outcome outcome = build.stopped ? stopped_build(build, options.folder,
                                                  inputs.cells ? "the same command" : "--resume")
                                  : written_libraries(build.libraries, inputs.out);
  for (Warning& each : goal_warnings(inputs.library.goal, grid.machines)) {
    outcome.warnings.push_back(std::move(each));
  }
  if (own) build.stopped ? own->keep() : own->clear();
  outcome.json["wall_time_s"] = watch.seconds();
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
