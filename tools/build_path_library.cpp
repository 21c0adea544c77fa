// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <vector>

#include <excavplan/library/library_build.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "shared/ranks.hpp"
#include "shared/results.hpp"
#include "shared/tool.hpp"

namespace excavplan::tools {
namespace {

namespace fs = std::filesystem;

const About about = {
    "build-path-library",
    "searches the dig of the highest efficiency for each density of a soil by digging the "
    "simulator, and writes them to a library that plan-path looks up. Several machines, soils and "
    "slopes make a library for each machine and soil. It works in parallel by threads, under "
    "mpirun, and in shards that need not know of each other, with the same result.",
    {{"build-path-library --out loam.json", "the default: 0, 5 .. 100 % in loam with the ZX120"},
     {"build-path-library --soil sand --densities 20:10:80 --out sand.json", "a coarser one"},
     {"build-path-library --out loam.json --resume", "go on after an interrupt"},
     {"build-path-library --soil loam,sand,clay --slopes=-10deg,0,10deg --out libraries",
      "three libraries of three slopes each in the folder libraries"},
     {"build-path-library --cells cells --shard 3/20", "one of twenty jobs of a cluster"},
     {"build-path-library --merge cells --out loam.json", "what those jobs computed"},
     {"mpirun -n 4 build-path-library --out loam.json", "in four processes"}},
    false,
    true};

struct Inputs {
  std::string densities = "0:5:100";
  std::string slopes = "0";
  std::string soils = "loam";
  std::string machines = "zx120";
  std::string method = "memetic";
  AnchoredSearch anchored;
  GeneticAlgorithm genetic;
  double cell_size = LibrarySearch{}.cell_size;
  std::uint64_t seed = LibrarySearch{}.seed;
  double refine = 0.0;
  std::uint64_t threads = 0;
  bool resume = false;
  std::optional<std::string> cells;
  std::optional<std::string> shard;
  std::optional<std::string> merge;
  std::optional<std::string> out;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.text("densities", "FIRST:STEP:LAST", inputs.densities,
                 "relative densities [%], or a list a,b,c");
  arguments.text("slopes", "LIST", inputs.slopes,
                 "slopes of the ground, rising away from the machine: first:step:last or a,b,c "
                 "[rad]");
  arguments.text("soil", "NAME,..", inputs.soils, "loam, sand, clay, gravel or soil files");
  arguments.text("machine", "NAME,..", inputs.machines, "zx120 or machine files");
  arguments.choice("method", inputs.method, {"memetic", "paper"},
                   "memetic: three densities searched from nothing, the others from neighbours; "
                   "paper: a genetic algorithm for each");
  arguments.option("points", inputs.anchored.points,
                   "memetic: digs that the search from nothing begins with");
  arguments.option("polish", inputs.anchored.polish_evaluations,
                   "memetic: digs of one Nelder-Mead search");
  arguments.option("inherited", inputs.anchored.inherited_evaluations,
                   "memetic: digs of a density that starts from its neighbours");
  arguments.option("population", inputs.genetic.population, "paper: individuals of a generation");
  arguments.option("generations", inputs.genetic.generations, "paper: generations of a search");
  arguments.option("cell", inputs.cell_size, Quantity::length, "cell of the simulated ground");
  arguments.option("seed", inputs.seed, "seed; the same seed gives the same file");
  arguments.option("refine", inputs.refine, Quantity::percent,
                   "add densities midway, down to 1 % apart, wherever the look-up there gives away "
                   "more of the efficiency than this; 0 for none");
  arguments.option("threads", inputs.threads, "threads, 0 for one per core; same file for any");
  arguments.file("cells", inputs.cells,
                 "folder for the file of each density, kept; what it holds is not computed again "
                 "(default: beside --out, removed at the end)");
  arguments.text("shard", "I/N", inputs.shard, "compute only the I-th of N parts into --cells");
  arguments.file("merge", inputs.merge,
                 "make the library of the cells that shards put into this folder; the grid and the "
                 "search are theirs");
  arguments.flag("resume", inputs.resume, "keep what an interrupted run with this --out computed");
  arguments.file("out", inputs.out,
                 "library to write; with several machines or soils a folder for "
                 "MACHINE-SOIL.json of each");
}

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

LibraryShard shard_of(const std::string& text) {
  LibraryShard shard{0, 0};
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  if (error == std::errc{} && slash != end && *slash == '/') {
    const auto [stop, wrong] = std::from_chars(slash + 1, end, shard.count);
    if (wrong == std::errc{} && stop == end && shard.index >= 1 && shard.index <= shard.count) {
      return shard;
    }
  }
  throw Error(ErrorKind::bad_input, "--shard: '" + text + "' is not one of 1/N .. N/N");
}

// ---- What the shards of one build have in common ----------------------------------------------

constexpr const char* job_format = "excavplan-library-job";

std::string job_file(const std::string& folder) { return folder + "/job.json"; }

/// The options that decide the libraries.
std::string job_text(const Inputs& inputs) {
  return sealed_text({{"format", job_format},
                      {"version", 1},
                      {"densities", inputs.densities},
                      {"slopes", inputs.slopes},
                      {"soil", inputs.soils},
                      {"machine", inputs.machines},
                      {"method", inputs.method},
                      {"points", inputs.anchored.points},
                      {"polish", inputs.anchored.polish_evaluations},
                      {"inherited", inputs.anchored.inherited_evaluations},
                      {"population", inputs.genetic.population},
                      {"generations", inputs.genetic.generations},
                      {"cell_m", inputs.cell_size},
                      {"seed", inputs.seed},
                      {"refine_percent", inputs.refine}});
}

/// The same inputs with the options of a folder's job.
Inputs with_job(Inputs inputs, const std::string& folder) {
  const std::string name = job_file(folder);
  JsonObject job = JsonObject::open_sealed(name, read_file(name), job_format);
  const auto whole = [&](const char* key) { return static_cast<int>(job.number(key, 0.0, 1e9)); };
  inputs.densities = job.text("densities");
  inputs.slopes = job.text("slopes");
  inputs.soils = job.text("soil");
  inputs.machines = job.text("machine");
  inputs.method = job.text("method");
  inputs.anchored.points = whole("points");
  inputs.anchored.polish_evaluations = whole("polish");
  inputs.anchored.inherited_evaluations = whole("inherited");
  inputs.genetic.population = whole("population");
  inputs.genetic.generations = whole("generations");
  inputs.cell_size = job.number("cell_m");
  inputs.seed = static_cast<std::uint64_t>(job.number("seed", 0.0, most_exact));
  inputs.refine = job.number("refine_percent");
  job.done();
  return inputs;
}

/// A merge takes the options of its cells: those given here must be the same.
void require_agreement(const Inputs& given, const std::string& folder) {
  const auto usual = nlohmann::json::parse(job_text(Inputs{}));
  const auto asked = nlohmann::json::parse(job_text(given));
  const auto job = nlohmann::json::parse(job_text(with_job(given, folder)));
  for (const auto& [key, value] : asked.items()) {
    if (key == "checksum" || value == usual[key] || value == job[key]) continue;
    throw Error(ErrorKind::bad_input, job_file(folder) + ": " + key + " is " + job[key].dump() +
                                          ", " + value.dump() +
                                          " is asked for; a merge takes the options of its cells");
  }
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

/// Makes the folder and notes the job in it, or checks that it is of the same job.
void begin_job(const Inputs& inputs, const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string name = job_file(folder);
  if (!fs::exists(name)) return write_file(name, job_text(inputs));
  if (job_text(with_job(inputs, folder)) != job_text(inputs)) {
    throw Error(ErrorKind::bad_input, name +
                                          ": is of another run: give the options it names, or "
                                          "another folder");
  }
}

// ---- The work ---------------------------------------------------------------------------------

void check(const Inputs& inputs) {
  const auto refuse = [](const std::string& text) { throw Error(ErrorKind::bad_input, text); };
  if (!inputs.shard && !inputs.out) refuse("--out is missing: library to write");
  if (inputs.shard && (!inputs.cells || inputs.merge || inputs.out)) {
    refuse("--shard goes with --cells, and without --merge and --out");
  }
  if (inputs.merge && (inputs.cells || inputs.resume)) {
    refuse("--merge goes without --cells and --resume");
  }
}

std::string folder_of(const Inputs& inputs) {
  if (inputs.merge) return *inputs.merge;
  return inputs.cells ? *inputs.cells : *inputs.out + ".cells";
}

/// Whether the cells' folder is of this run alone.
bool folder_is_ours(const Inputs& inputs) { return !inputs.cells && !inputs.merge; }

LibraryBuildOptions options_of(const Inputs& inputs, Console& console) {
  LibraryBuildOptions options;
  if (inputs.method == "paper") {
    options.search.method = inputs.genetic;
  } else {
    options.search.method = inputs.anchored;
  }
  options.search.cell_size = inputs.cell_size;
  options.search.seed = inputs.seed;
  options.refine = inputs.refine / 100.0;
  options.threads = static_cast<unsigned>(inputs.threads);
  options.folder = folder_of(inputs);
  options.only_merge = inputs.merge.has_value();
  options.note = [&console](const std::string& line) { console.note(line); };
  options.progress = [&console](const LibraryProgress& now) {
    const std::string left =
        std::isnan(now.seconds_left) ? "" : ", " + readable(now.seconds_left, 2) + " s left";
    console.progress(static_cast<double>(now.cells_done) / static_cast<double>(now.cells),
                     std::to_string(now.cells_done) + " of " + std::to_string(now.cells) +
                         " densities, " + std::to_string(now.evaluations) + " digs, now " +
                         readable(1000.0 * now.best) + " kg/kJ" + left);
    return !console.stop_requested();
  };
  return options;
}

nlohmann::ordered_json library_json(const PathLibrary& library) {
  auto json = nlohmann::ordered_json::parse(to_json(library));
  for (const char* key : {"format", "version", "checksum"}) json.erase(key);
  return json;
}

void add_lines(const PathLibrary& library, const std::string& file, Outcome& outcome) {
  outcome.lines.push_back(file + ": " + std::to_string(library.entries.size()) + " digs of " +
                          library.machine + " in " + library.soil + ", " +
                          std::to_string(library.evaluations()) + " digs simulated");
  const bool sloped = library.entries.front().slope != library.entries.back().slope;
  for (const PathLibraryEntry& entry : library.entries) {
    outcome.lines.push_back(readable(entry.density_percent) + " %" +
                            (sloped ? " on " + readable(entry.slope) + " rad" : "") + ": " +
                            path_text(entry.dig) + ", " +
                            readable(1000.0 * entry.dig.efficiency()) + " kg/kJ");
  }
}

Outcome report_libraries(const Inputs& inputs, const LibraryBuild& build) {
  Outcome outcome;
  if (build.libraries.size() == 1) {
    const PathLibrary& library = build.libraries.front();
    write_file(*inputs.out, to_json(library));
    outcome.json = library_json(library);
    add_lines(library, *inputs.out, outcome);
    return outcome;
  }
  fs::create_directories(*inputs.out);
  int evaluations = 0;
  for (const PathLibrary& library : build.libraries) {
    const std::string file = *inputs.out + "/" + file_name(library);
    write_file(file, to_json(library));
    outcome.json["libraries"].push_back({{"file", file}});
    outcome.json["libraries"].back().update(library_json(library));
    evaluations += library.evaluations();
    add_lines(library, file, outcome);
  }
  outcome.json["evaluations"] = evaluations;
  return outcome;
}

Outcome report_cells(const Inputs& inputs, const LibraryBuild& build) {
  Outcome outcome;
  outcome.stopped_early = build.stopped;
  outcome.json = {{"cells", build.cells}, {"cells_done", build.cells_done}};
  outcome.lines.push_back(folder_of(inputs) + ": " + std::to_string(build.cells_done) + " of " +
                          std::to_string(build.cells) + " densities");
  if (build.stopped) {
    outcome.lines.push_back(inputs.shard || inputs.cells ? "the same command goes on from there"
                                                         : "--resume goes on from there");
  }
  return outcome;
}

/// Now, not after the search.
void require_writable(const std::string& out, bool several) {
  require_folder_of(out);
  if (!fs::exists(out) || fs::is_directory(out) == several) return;
  throw Error(ErrorKind::bad_file,
              out + (several ? ": is a file, several libraries need a folder"
                             : ": is a folder, the library needs a file of its own"));
}

/// Removes what a run put into a folder of its own, and the folder if nothing else is in it.
void remove_cells(const std::string& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::exists(job_file(folder)) && !fs::is_empty(folder)) {
    throw Error(ErrorKind::bad_file, folder +
                                         ": is no folder of cells, and would have to be one; "
                                         "remove it, or give another --cells");
  }
  for (const auto& file : fs::directory_iterator(folder)) {
    const std::string name = file.path().filename();
    const bool part = name.find(".json.part-") != std::string::npos;
    if (part || file.path().extension() == ".json") fs::remove(file.path());
  }
  if (fs::is_empty(folder)) fs::remove(folder);
}

/// What one process does before all, so that the others find it done.
void prepare(const Inputs& inputs, const LibraryGrid& grid) {
  if (inputs.out) require_writable(*inputs.out, grid.machines.size() * grid.soils.size() > 1);
  if (folder_is_ours(inputs) && !inputs.resume) remove_cells(folder_of(inputs));
  if (!inputs.merge) begin_job(inputs, folder_of(inputs));
}

/// They share out one build.
void require_same_job(const Inputs& inputs, Ranks& ranks) {
  const std::string own = job_text(inputs) + inputs.shard.value_or("");
  for (const std::string& other : ranks.exchange(own)) {
    if (other == own) continue;
    throw Error(ErrorKind::bad_input,
                "the ranks of an MPI job share out the work by themselves: give all of them the "
                "same options, and the same --shard");
  }
}

Outcome work(Inputs inputs, Console& console, Ranks* ranks) {
  const Stopwatch watch;
  check(inputs);
  const std::vector<Warning> warnings = warnings_of(inputs);
  if (inputs.merge) {
    require_agreement(inputs, *inputs.merge);
    inputs = with_job(inputs, *inputs.merge);
  }
  const LibraryGrid grid = grid_of(inputs);
  const std::optional<LibraryShard> shard =
      inputs.shard ? std::optional(shard_of(*inputs.shard)) : std::nullopt;
  LibraryBuildOptions options = options_of(inputs, console);
  require_buildable(grid, options);
  const bool leads = ranks == nullptr || ranks->rank() == 0;
  if (ranks != nullptr) require_same_job(inputs, *ranks);
  if (leads) prepare(inputs, grid);
  if (ranks != nullptr) {
    ranks->exchange({});
    if (inputs.threads == 0) options.threads = 1;
  }
  options.sharing = ranks;
  const LibraryBuild build =
      shard ? build_library_shard(grid, *shard, options) : build_path_libraries(grid, options);
  Outcome outcome;
  if (build.stopped || inputs.shard) {
    outcome = report_cells(inputs, build);
  } else if (leads) {
    outcome = report_libraries(inputs, build);
    if (folder_is_ours(inputs)) remove_cells(folder_of(inputs));
  }
  outcome.json["wall_time_s"] = watch.seconds();
  outcome.warnings = warnings;
  return outcome;
}

/// What a stream is given while this lives.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* before_;
};

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  const auto ranks = Ranks::started();
  std::vector<const char*> words(argv, argv + argc);
  std::optional<Captured> answer, errors;
  if (ranks && ranks->rank() != 0) {  // the first speaks for all
    words.push_back("--quiet");       // but for errors
    answer.emplace(std::cout);
    errors.emplace(std::cerr);
  }
  const int code = tool_main(
      static_cast<int>(words.size()), words.data(), about, declare,
      [&](const Inputs& inputs, Console& console) { return work(inputs, console, ranks.get()); });
  if (ranks) ranks->end(code, errors ? errors->text() : "");
  return code;
}
