// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "build_path_library/library_results.hpp"

#include <filesystem>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "inputs/goal_inputs.hpp"
#include "results/results.hpp"

namespace excavplan::tools {
namespace {

namespace fs = std::filesystem;

void add_lines(const PathLibrary& library, const std::string& file, Outcome& outcome) {
  outcome.lines.push_back(file + ": " + std::to_string(library.entries.size()) + " digs of " +
                          library.machine + " in " + library.soil + ", " +
                          std::to_string(library.evaluations()) + " digs simulated");
  const bool sloped = library.entries.front().slope != library.entries.back().slope;
  for (const PathLibraryEntry& entry : library.entries) {
    outcome.lines.push_back(readable(entry.density_percent) + " %" +
                            (sloped ? " on " + readable(entry.slope) + " rad" : "") + ": " +
                            path_text(entry.dig) + ", " +
                            worth_text(library.objective, library.objective.worth(entry.dig)));
  }
}

}  // namespace

void require_library_place(const LibraryGrid& grid, const DigObjective& objective,
                           const std::string& out) {
  std::error_code none;
  const bool several = grid.machines.size() * grid.soils.size() > 1;
  const bool folder = fs::is_directory(out, none);
  if (folder != several && fs::exists(fs::symlink_status(out, none))) {
    throw Error(ErrorKind::bad_file, out + (several ? ": is a file, several libraries need a folder"
                                                    : ": is a folder, the library needs a file"));
  }
  if (!folder) return require_writable(out);
  for (const Machine& machine : grid.machines) {
    for (const SoilKind& soil : grid.soils) {
      PathLibrary library;
      library.machine = machine.name;
      library.soil = soil.name;
      library.objective = objective;
      require_writable(out + "/" + file_name(library));
    }
  }
}

Outcome written_libraries(const std::vector<PathLibrary>& libraries, const std::string& out) {
  Outcome outcome;
  if (libraries.size() == 1) {
    const PathLibrary& library = libraries.front();
    write_file(out, to_json(library));
    outcome.json = library_json(library);
    add_lines(library, out, outcome);
    return outcome;
  }
  make_folder(out);
  outcome.json["libraries"] = nlohmann::ordered_json::array();
  int evaluations = 0;
  for (const PathLibrary& library : libraries) {
    const std::string file = out + "/" + file_name(library);
    write_file(file, to_json(library));
    outcome.json["libraries"].push_back({{"file", file}});
    outcome.json["libraries"].back().update(library_json(library));
    evaluations += library.evaluations();
    add_lines(library, file, outcome);
  }
  outcome.json["evaluations"] = evaluations;
  return outcome;
}

Outcome stopped_build(const LibraryBuild& build, const std::string& folder,
                      const std::string& how) {
  Outcome outcome;
  outcome.stopped_early = true;
  outcome.json = {{"cells", build.entries}, {"cells_done", build.entries_done}};
  outcome.lines = {folder + ": " + std::to_string(build.entries_done) + " of " +
                       std::to_string(build.entries) + " densities",
                   how + " continues from there"};
  return outcome;
}

}  // namespace excavplan::tools
