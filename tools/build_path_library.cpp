// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <excavplan/planning/path_library.hpp>

#include "json_file.hpp"
#include "results.hpp"
#include "tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "build-path-library",
    "searches the dig of the highest efficiency for each density of a soil by digging the "
    "simulator, and writes them to a library that plan-path looks up.",
    {{"build-path-library --out loam.json", "the default: 0, 5 .. 100 % in loam with the ZX120"},
     {"build-path-library --soil sand --densities 20:10:80 --out sand.json", "a coarser one"},
     {"build-path-library --out loam.json --resume", "go on after an interrupt"}},
    false,
    true};

struct Inputs {
  std::string densities = "0:5:100";
  std::string soil = "loam";
  std::string machine = "zx120";
  GeneticAlgorithm genetic;
  std::uint64_t seed = DigSearchOptions{}.seed;
  double cell = 0.05;
  std::uint64_t threads = 0;
  bool resume = false;
  std::string out;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.option("population", inputs.genetic.population, "individuals of a generation");
  arguments.option("generations", inputs.genetic.generations, "generations of a search");
  arguments.option("cell", inputs.cell, Quantity::length, "cell of the simulated ground");
  arguments.option("seed", inputs.seed, "seed; the same seed gives the same file");
  arguments.option("threads", inputs.threads, "threads, 0 for one per core; same file for any");
  arguments.flag("resume", inputs.resume, "keep the densities that --out already holds");
  arguments.file("out", inputs.out, "library file to write");
  arguments.require("out");
}

/// Entries of an earlier run, if it was the same run.
std::vector<PathLibraryEntry> earlier_entries(const Inputs& inputs, const Machine& machine,
                                              const SoilKind& soil) {
  if (!inputs.resume || !std::filesystem::exists(inputs.out)) return {};
  PathLibrary library = load_path_library(inputs.out);
  if (library.machine != machine.name || library.soil != soil.name || library.seed != inputs.seed ||
      library.cell != inputs.cell || library.population != inputs.genetic.population ||
      library.generations != inputs.genetic.generations) {
    throw Error(ErrorKind::bad_input,
                "--resume: " + inputs.out + " is of machine " + library.machine + ", soil " +
                    library.soil + ", cell " + number_text(library.cell) + " m, seed " +
                    std::to_string(library.seed) + ", population " +
                    std::to_string(library.population) + ", generations " +
                    std::to_string(library.generations) + ", which is another run than this one");
  }
  return library.entries;
}

Outcome work(const Inputs& inputs, Console& console) {
  const Stopwatch watch;
  const Machine machine = machine_named(inputs.machine);
  const SoilKind soil = soil_named(inputs.soil);
  const auto densities = parse_densities("--densities", inputs.densities);

  require_folder_of(inputs.out);  // now, not after the search
  LibraryBuildOptions options;
  options.cell = inputs.cell;
  options.search.method = inputs.genetic;
  options.search.seed = inputs.seed;
  options.search.threads = static_cast<unsigned>(inputs.threads);
  options.done = earlier_entries(inputs, machine, soil);
  options.search.progress = [&](const SearchProgress&) { return !console.stop_requested(); };
  options.progress = [&](std::size_t done, std::size_t wanted, const PathLibraryEntry& entry) {
    console.progress(static_cast<double>(done) / static_cast<double>(wanted),
                     "density " + readable(entry.density_percent) +
                         " %: " + readable(1000.0 * entry.dig.efficiency()) + " kg/kJ");
    return !console.stop_requested();
  };
  const PathLibrary library = build_path_library(machine, soil, densities, options);

  Outcome outcome;
  outcome.stopped_early = library.entries.size() < densities.size();
  if (!library.entries.empty()) write_file(inputs.out, to_json(library));
  outcome.json = nlohmann::ordered_json::parse(to_json(library));
  outcome.json.erase("format");
  outcome.json.erase("version");
  outcome.json["wall_time_s"] = watch.seconds();
  outcome.lines.push_back(inputs.out + ": " + std::to_string(library.entries.size()) + " of " +
                          std::to_string(densities.size()) + " densities, " +
                          std::to_string(library.evaluations()) + " digs simulated, " +
                          readable(watch.seconds()) + " s");
  for (const PathLibraryEntry& entry : library.entries) {
    outcome.lines.push_back(readable(entry.density_percent) + " %: " + path_text(entry.dig) + ", " +
                            readable(1000.0 * entry.dig.efficiency()) + " kg/kJ");
  }
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
