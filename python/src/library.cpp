// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/planning/library_build.hpp>
#include <excavplan/planning/path_library.hpp>
#include <excavplan/planning/plan_dig.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "rooms.hpp"
#include "simulators.hpp"

namespace excavplan::python {
namespace {

using py::arg;

std::optional<PathLibrary> built(const Machine& machine, const SoilKind& soil,
                                 const std::vector<double>& densities,
                                 const std::vector<double>& slopes,
                                 const std::optional<DigObjective>& objective, double cell_size,
                                 std::uint64_t seed, const py::object& simulator, unsigned threads,
                                 const File& folder, const py::object& progress) {
  const auto own = std::make_shared<Call>();
  LibraryBuildOptions options;
  options.search.objective = objective.value_or(options.search.objective);
  options.search.cell_size = cell_size;
  options.search.seed = seed;
  options.search.simulator = simulator_kind(simulator, own);
  options.threads = threads_with(simulator, threads);
  options.folder = folder.path;
  options.progress = [own, callback = shared(progress)](const LibraryProgress& state) {
    return !own->failed() && goes_on(*own, *callback, state);
  };
  const LibraryGrid grid{{machine}, {soil}, slopes, densities};
  const LibraryBuild build = own->run([&] { return build_path_libraries(grid, options); });
  if (build.libraries.empty()) return std::nullopt;
  return build.libraries.front();
}

}  // namespace

void bind_library(py::module_& module) {
  py::class_<MidwayError>(module, "MidwayError", "How far a path looked up is off.")
      .def_readonly("loss", &MidwayError::loss, "Fraction of the best worth that is lost [-].")
      .def_readonly("expectation", &MidwayError::expectation,
                    "Expected worth over true, less 1 [-].");
  py::class_<PathLibraryEntry>(module, "PathLibraryEntry", "The best dig for a density on a slope.")
      .def_readonly("density_percent", &PathLibraryEntry::density_percent, "[%]")
      .def_readonly("slope", &PathLibraryEntry::slope, "Rising away from the machine [rad].")
      .def_readonly("dig", &PathLibraryEntry::dig, "The best one found.")
      .def_readonly("evaluations", &PathLibraryEntry::evaluations, "Digs simulated for it.");
  py::class_<PathLibrary>(module, "PathLibrary", "Best digs of one machine in one soil.")
      .def_readonly("machine", &PathLibrary::machine, "Its name.")
      .def_readonly("soil", &PathLibrary::soil, "Its name.")
      .def_readonly("simulator", &PathLibrary::simulator, "Name and version.")
      .def_readonly("cell_size", &PathLibrary::cell_size, "Of its ground [m].")
      .def_readonly("objective", &PathLibrary::objective, "That the digs are best for.")
      .def_readonly("entries", &PathLibrary::entries, "Slope rising, then density.")
      .def_property_readonly(
          "file", [](const PathLibrary& library) { return File{library.file}; },
          "That it was read from; empty: none.")
      .def(
          "look_up",
          [](const PathLibrary& library, double density, double slope) {
            return look_up(library, density, slope);
          },
          arg("density_percent"), arg("slope") = 0.0,
          "The dig for a density [%] and a slope [rad].")
      .def(
          "look_up_error",
          [](const PathLibrary& library, double density, double slope) {
            return look_up_error(library, density, slope);
          },
          arg("density_percent"), arg("slope") = 0.0, "How far that may be off.")
      .def(
          "to_json", [](const PathLibrary& library) { return to_json(library); },
          "The text of a library file.");
  module.def(
      "load_path_library",
      [](const File& name) { return load_path_library(shipped_or_file("libraries", name.path)); },
      arg("name_or_file"), "'zx120-loam-cycle', ... or a library file.");
  module.def(
      "shipped_library",
      [](const Machine& machine, const SoilKind& soil,
         const std::optional<DigObjective>& objective) {
        return shipped_library(machine, soil, objective.value_or(dig_goals().front().goal));
      },
      arg("machine"), arg("soil"), arg("objective") = py::none(),
      "The library that excavplan ships for a machine in a soil and an objective.");
  py::class_<LibraryProgress>(module, "LibraryProgress", "How far a build is.")
      .def_readonly("entries_done", &LibraryProgress::entries_done)
      .def_readonly("entries", &LibraryProgress::entries, "Of the whole build.")
      .def_readonly("evaluations", &LibraryProgress::evaluations, "Digs simulated.");
  module.def("build_path_library", &built, arg("machine"), arg("soil"), arg("densities_percent"),
             arg("slopes") = std::vector<double>{0.0}, py::kw_only(), arg("objective") = py::none(),
             arg("cell_size") = LibrarySearch{}.cell_size, arg("seed") = 1,
             arg("simulator") = py::none(), arg("threads") = 0, arg("folder") = "",
             arg("progress") = py::none(),
             "Searches the best dig for each density [%] on each slope [rad], as\n"
             "build-path-library does. folder: of the entries' files, kept for a build that is\n"
             "interrupted; progress: is called with a LibraryProgress. None if it was stopped.");
}

}  // namespace excavplan::python
